// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/tables/result_records.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "base/located.h"
#include "base/text.h"
#include "delquad/error.h"
#include "io/cases/read_record.h"
#include "io/digest.h"
#include "io/mesh_io.h"
#include "metrics/tables/study_fields.h"

namespace delquad {

namespace {

namespace fs = std::filesystem;
using namespace nlohmann::literals;
using Json = nlohmann::ordered_json;

/// Adds processor times; for steps in other processes, such as reading CAD, wall-clock times.
void add_step_times(const Json& record, std::map<std::string, double>& values) {
  Json seconds = record.at("seconds");
  seconds.update(record.value("cpu_seconds", Json::object()));
  double total = 0;
  for (const char* step : {"start", "write", "peer"}) total += seconds.value(step, 0.0);
  for (const StepTime& time : step_times_of_tables()) {
    if (*time.step == 0) values[time.key] = total;
    const auto at = seconds.find(time.step);
    if (at == seconds.end()) continue;
    total += values[time.key] = at->get<double>();
  }
}

Metric parse_metric(const Json& json) {
  Metric metric{"", "", "", Better::kNeither, std::numeric_limits<double>::quiet_NaN(), ""};
  RecordReader().object(json, metric);
  return metric;
}

CalibrationRecord parse_calibration(const Json& json) {
  return {
      json.at("to"),   json.at("size_factor"),    json.value("wanted_quads", 0.0), json.value("quads", 0.0),
      json.at("runs"), json.value("ended_by", "")};
}

std::string text_of_variant(const std::vector<std::pair<std::string, std::string>>& variant) {
  std::string text;
  for (const auto& [title, value] : variant) text += (text.empty() ? "@" : ",") + title + "=" + value;
  return text;
}

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

double number(const Json& value) { return value.is_null() ? kNoNumber : value.get<double>(); }

double at(const Json& json, const char* pointer) {
  return number(json.value(Json::json_pointer(pointer), Json()));
}

struct Derived {
  Metric column;
  std::function<double(const Json& record)> value;
};

const std::vector<Derived>& derived() {
  using enum Better;
  static const std::vector<Derived> all = {
      {{"row_ends", "row ends", "", kNeither, kNoNumber, "rows of quads that are expected to end", 0},
       [](const Json& r) { return at(r, "/cross_field/row_ends"); }},
      {{kFinishSeconds, "finish s", "s", kNeither, kNoNumber, "processor time of the finish steps", 2},
       [](const Json& r) { return at(r, "/finish/seconds"); }},
      {{"deviation", "deviation, sizes", "delta", kNeither, kNoNumber, "largest distance of mesh and surface",
        3},
       [](const Json& r) {
         const std::string distances = "/surface/distances_in_diagonals/";
         return std::fmax(at(r, (distances + "mesh_to_surface/max_in_sizes").c_str()),
                          at(r, (distances + "surface_to_mesh/max_in_sizes").c_str()));
       }},
      {{"warnings", "warnings", "", kNeither, kNoNumber, "number of warnings", 0},
       [](const Json& r) {
         return r.contains("warnings") ? static_cast<double>(r["warnings"].size()) : kNoNumber;
       }},
  };
  return all;
}

CellRecord parse(const Json& json) {
  check_record_version(json.value("record", 1));
  CellRecord record;
  json.at("case").get_to(record.name);
  json.at("pipeline").get_to(record.pipeline);
  const Json variant = json.value("variant", Json::object());
  for (const auto& [title, value] : variant.items())
    record.variant.emplace_back(title, value.get<std::string>());
  record.group = record.name + text_of_variant(record.variant);
  record.quads_only = json.value("quads_only", true);
  record.model = json.value("/digests/model"_json_pointer, "");
  record.is_peer = json.contains("peer");
  record.seed = json.value("seed", 0LL);
  if (const auto status = json.at("status").get<std::string>(); status != "ok") {
    json.at("reason").get_to(record.reason);
    record.skipped = status == "skipped" || status == kNotApplicable;
    record.kind = json.value("kind", "");
    return record;
  }
  for (const auto& [key, value] : json.at("metrics").get<std::map<std::string, Json>>())
    record.values[key] = number(value);
  for (const Json& metric : json.value("own_metrics", Json::array()))
    record.added_metrics.push_back(parse_metric(metric));
  record.failed_metrics = json.value("failed_metrics", std::map<std::string, std::string>());
  record.metric_failed = json.contains("metrics_status");
  record.values["seconds"] = number(json.at("meshing_seconds"));
  for (const auto& [column, of_record] : derived()) record.values[column.key] = of_record(json);
  if (json.contains("seconds")) add_step_times(json, record.values);
  if (json.contains("warnings")) json.at("warnings").get_to(record.warnings);
  if (json.contains("unsound")) json.at("unsound").get_to(record.unsound);
  if (json.contains(kCalibrationStep)) record.calibration = parse_calibration(json.at(kCalibrationStep));
  record.size_adapted_to = json.value("/domain/size_adapted_to"_json_pointer, std::vector<std::string>());
  const Json problem = json.value("problem", Json::object()), size = problem.value("size", Json::object());
  const std::string base = size.value("base", Json()).is_string() ? size.at("base").get<std::string>() : "";
  const bool is_other = problem.value("refine", 1.0) != 1 || !problem.value("quads", Json()).is_null();
  if (!is_other && as_number(base) && size.value("source", Json::array()).empty() &&
      size.value("on", Json::array()).empty())
    record.uniform_size = base;
  return record;
}

/// Place after all others.
constexpr std::array<std::size_t, 3> kNoPlace = {std::numeric_limits<std::size_t>::max(), 0, 0};

/// Returns the study, or nothing if it is unreadable, since records have all but the order.
std::optional<StudyFile> readable_study(const fs::path& folder) {
  try {
    return read_study(folder);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

/// Returns a damaged record; its folder identifies the cell.
CellRecord damaged_record(const fs::path& file, const std::string& problem,
                          const std::optional<StudyFile>& study) {
  CellRecord record;
  record.pipeline = file.parent_path().filename().string();
  record.group = record.name = file.parent_path().parent_path().filename().string();
  const auto cell = study ? find_cell(*study, record.group, record.pipeline) : std::nullopt;
  if (cell) {
    record.name = record.group = cell->name;
    record.variant = cell->variant;
    record.group += text_of_variant(record.variant);
  }
  record.kind = "damaged";
  record.reason = "damaged record: " + problem;
  return record;
}

CellRecord read_record(const fs::path& file, const std::optional<StudyFile>& study) {
  CellRecord record;
  try {
    const std::string text = file_bytes(file);
    const Json json = Json::parse(text);
    record =
        json.contains("digest") && !is_sealed(text)
            ? damaged_record(file, file.string() + ": was changed: its digest does not fit its text", study)
            : parse(json);
  } catch (const std::exception& error) {  // from Json, or InputError
    record = damaged_record(file, json_problem(file, "", error), study);
  }
  record.folder = file.parent_path();
  return record;
}

}  // namespace

const std::vector<Metric>& columns_of_records() {
  static const std::vector<Metric> all = [] {
    std::vector<Metric> columns;
    for (const Derived& one : derived()) columns.push_back(one.column);
    columns.push_back({"seconds", "s", "s", Better::kLower, HUGE_VAL,
                       "time on the clock from insertion to projection; not for peers", 2});
    for (const auto& [key, title, step] : step_times_of_tables())
      columns.push_back({key, title, "s", Better::kLower, HUGE_VAL,
                         *step == 0 ? "processor time from the start of the program to the written mesh"
                                    : fmt::format("processor time of the step '{}'", step),
                         2});
    return columns;
  }();
  return all;
}

std::vector<Metric> added_metrics_of(const std::vector<CellRecord>& records) {
  std::vector<Metric> metrics;
  for (const CellRecord& record : records)
    for (const Metric& metric : record.added_metrics)
      if (std::ranges::find(metrics, metric.key, &Metric::key) == metrics.end()) metrics.push_back(metric);
  std::vector<Metric> all;
  for (const Metric& metric : metrics) {
    std::set<std::string> parts;
    for (const CellRecord& record : records)
      for (const auto& [key, value] : record.values)
        if (key.starts_with(metric.key + ".")) parts.insert(key);
    const auto has_whole = [&](const CellRecord& record) { return record.values.contains(metric.key); };
    if (parts.empty() || std::ranges::any_of(records, has_whole)) all.push_back(metric);
    for (const std::string& key : parts) {
      all.push_back(metric);
      all.back().key = key;
      all.back().title += key.substr(metric.key.size());
    }
  }
  return all;
}

std::vector<fs::path> record_files(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::recursive_directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    if (at->path().filename().string().starts_with('.')) at.disable_recursion_pending();  // unfinished
    if (at->path().filename() == "record.json") files.push_back(at->path());
  }
  if (error) throw InputError(folder.string() + ": " + cannot_be_read(error.message()));
  std::sort(files.begin(), files.end());
  return files;
}

const std::string& domain_of(const CellRecord& record) {
  return record.domain.empty() ? record.name : record.domain;
}

std::vector<CellRecord> read_records(const fs::path& folder) {
  const std::vector<fs::path> files = record_files(folder);
  if (files.empty())
    throw InputError(folder.string() + ": holds no record.json: expected the folder of 'delquad run -o'");
  const std::optional<StudyFile> study = readable_study(folder);
  std::vector<CellRecord> records;
  std::set<std::pair<std::string, std::string>> seen;
  for (const fs::path& file : files) {
    records.push_back(read_record(file, study));
    const CellRecord& r = records.back();
    if (!seen.insert({r.group, r.pipeline}).second)
      refuse("{}: there is another record of {} {} in {}: give the folder of one experiment", file.string(),
             r.group, r.pipeline, folder.string());
  }
  if (study)
    std::ranges::stable_sort(records, {}, [&](const CellRecord& r) {
      return place_of(*study, {r.name, r.variant, r.pipeline}).value_or(kNoPlace);
    });
  const auto domains = study ? domains_of(*study) : std::map<std::string, std::string>();
  for (CellRecord& record : records)
    if (const auto at = domains.find(record.name); at != domains.end()) record.domain = at->second;
  return records;
}

void check_record_version(int version) {
  if (version == kRecordVersion) return;
  throw InputError(
      fmt::format("record of version {}: expected version {}: run the experiment again, in a new folder",
                  version, kRecordVersion));
}

bool has_mesh(const std::string& state) { return state == "done" || state == "metric failed"; }

std::string state_of_cell(const fs::path& folder, const std::string& key) {
  if (!fs::exists(folder / "record.json")) return "to do";
  const std::string text = file_bytes(folder / "record.json");
  if (!is_sealed(text)) return "damaged";
  const Json record = Json::parse(text);
  if (record.value("key", "") != key) return "outdated";
  if (record.contains("metrics_status")) return "metric failed";
  const std::string status = record.value("status", "");
  if (status != "ok") return status;
  std::error_code missing;
  const std::uintmax_t bytes = fs::file_size(folder / "mesh.msh", missing);
  return !missing && bytes == record.value("/files/mesh.msh/bytes"_json_pointer, 0U) ? "done" : "damaged";
}

}  // namespace delquad
