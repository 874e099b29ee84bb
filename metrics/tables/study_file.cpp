// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/tables/study_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/located.h"
#include "delquad/error.h"
#include "io/cases/read_record.h"
#include "io/digest.h"
#include "io/mesh_io.h"
#include "metrics/tables/result_records.h"
#include "metrics/tables/study_fields.h"

namespace delquad {

namespace {

/// Returns ":LINE:COLUMN" from the parser's text; empty if it has none.
std::string place_in(const std::string& text) {
  const auto at = text.find("at line ");
  int line = 0, column = 0;
  if (at == std::string::npos || std::sscanf(text.c_str() + at, "at line %d, column %d", &line, &column) != 2)
    return "";
  return fmt::format(":{}:{}", line, column);
}

std::string why(const std::exception& error) {
  const std::string text = error.what();
  const auto* json = dynamic_cast<const nlohmann::json::exception*>(&error);
  if (json == nullptr) return text;
  if (dynamic_cast<const nlohmann::json::parse_error*>(json) != nullptr) {
    const auto says = [&](const char* part) { return text.find(part) != std::string::npos; };
    return says("end of input") || says("missing closing quote") ? "it ends there, too early"
                                                                 : "no JSON there";
  }
  constexpr int kKeyNotFound = 403;
  const auto first = text.find('\''), last = text.rfind('\'');
  if (json->id == kKeyNotFound && first < last) return text.substr(first, last + 1 - first) + " is missing";
  return "a value in it is not of the expected kind";
}

}  // namespace

std::string json_problem(const std::filesystem::path& file, const std::string& what,
                         const std::exception& error) {
  return fmt::format("{}{}: {}{}{}", file.string(), place_in(error.what()), what, what.empty() ? "" : ": ",
                     why(error));
}

namespace {

using Json = nlohmann::ordered_json;
constexpr const char* kStudyFile = "study.json";

/// Limit of characters of a value in the name of a folder.
constexpr std::size_t kLongestValue = 40;

}  // namespace

std::string folder_text(const std::vector<std::string>& values, std::size_t i) {
  constexpr std::size_t kDigits = 8;  // digits of a digest
  const auto plain = [](const std::string& text) {
    std::string result = text;
    for (char& c : result)
      if (!std::isalnum(static_cast<unsigned char>(c)) && std::string("+-.").find(c) == std::string::npos)
        c = '_';
    return result;
  };
  const std::string text = plain(values[i]);
  const auto same = std::ranges::count_if(values, [&](const std::string& v) { return plain(v) == text; });
  return text.size() > kLongestValue || same > 1 ? "value-" + digest(values[i]).substr(0, kDigits) : text;
}

const std::vector<StepTime>& step_times_of_tables() {
  static const std::vector<StepTime> times = {{"seconds_read", "read s", "read"},
                                              {"seconds_maps", "maps s", "maps"},
                                              {"seconds_curves", "curves s", "curves"},
                                              {"seconds_fields", "fields s", "fields"},
                                              {"seconds_insertion", "insertion s", "insertion"},
                                              {"seconds_adaptation", "adaptation s", "adaptation"},
                                              {"seconds_smoothing", "smoothing s", "smoothing"},
                                              {"seconds_matching", "matching s", "matching"},
                                              {"seconds_treatment", "treatment s", "treatment"},
                                              {"seconds_cleanup", "clean-up s", "clean-up"},
                                              {"seconds_regularity", "regularity s", "regularity"},
                                              {"seconds_optimisation", "optimisation s", "optimisation"},
                                              {"seconds_parting", "parting s", "parting"},
                                              {"seconds_lifting", "lifting s", "lifting"},
                                              {"seconds_projection", "projection s", "projection"},
                                              {"seconds_total", "total CPU s", ""}};
  return times;
}

bool have_same_plan(const StudyFile& a, const StudyFile& b) {
  return (a.hypotheses.empty() && b.hypotheses.empty()) || a.plan == b.plan;
}

namespace {

bool are_same(const CaseGeometry& a, const CaseGeometry& b) {
  // Moments differ by up to three times the part that chords cut off.
  constexpr double kSame = 1e-5, kOfChords = 3;
  const double tolerance = kSame + kOfChords * (a.chord_error + b.chord_error);
  if (!a.digest.empty() && a.digest == b.digest) return true;
  return !a.shape.empty() && std::ranges::equal(a.shape, b.shape, [&](double x, double y) {
    return std::abs(x - y) <= tolerance * (1 + std::abs(x));
  });
}

}  // namespace

std::map<std::string, std::string> domains_of(const StudyFile& study) {
  std::map<std::string, std::string> domains;
  for (const std::string& name : study.cases) {
    const auto at = study.geometry.find(name);
    std::string& domain = domains[name] = name;
    if (at == study.geometry.end()) continue;
    if (!at->second.domain.empty()) domain = at->second.domain;
    for (const std::string& other : study.cases) {
      if (other == name || domain != name) break;
      const auto before = study.geometry.find(other);
      if (before != study.geometry.end() && are_same(before->second, at->second)) domain = domains[other];
    }
  }
  return domains;
}

void write_study(const std::filesystem::path& folder, const StudyFile& study) {
  Recorder recorder(true);
  Json json = {{"record", kRecordVersion}};
  json.update(recorder.object<TablePlan>(study));
  json.update(recorder.object<StudyCells>(study));
  write_text_file(folder / kStudyFile, sealed(json.dump(2) + "\n"));
}

std::optional<StudyFile> read_study(const std::filesystem::path& folder) {
  std::ifstream in(folder / kStudyFile);
  if (!in) return std::nullopt;
  try {
    const Json json = Json::parse(in);
    located((folder / kStudyFile).string(), [&] { check_record_version(json.value("record", 1)); });
    StudyFile study;
    const RecordReader reader({}, true);
    reader.object<TablePlan>(json, study);
    reader.object<StudyCells>(json, study);
    return study;
  } catch (const Json::exception& error) {
    throw InputError(json_problem(folder / kStudyFile, "does not describe an experiment's results", error));
  }
}

bool is_one_of(const MayFail& cells, const CellAddress& cell) {
  const auto is_it = [](const std::string& wanted, const std::string& text) {
    return wanted.empty() || wanted == text;
  };
  const auto variant =
      std::ranges::find(cell.variant, "variant", &std::pair<std::string, std::string>::first);
  return is_it(cells.name, cell.name) && is_it(cells.pipeline, cell.pipeline) &&
         is_it(cells.variant, variant == cell.variant.end() ? "" : variant->second);
}

bool may_fail(const TablePlan& plan, const CellAddress& cell) {
  return std::ranges::any_of(plan.may_fail, [&](const MayFail& cells) { return is_one_of(cells, cell); });
}

std::optional<std::array<std::size_t, 3>> place_of(const StudyFile& study, const CellAddress& cell) {
  const auto index = [](const std::vector<std::string>& list, const std::string& text) {
    return static_cast<std::size_t>(std::ranges::find(list, text) - list.begin());
  };
  std::array<std::size_t, 3> place = {index(study.cases, cell.name), 0,
                                      index(study.pipelines, cell.pipeline)};
  if (place[0] == study.cases.size() || place[2] == study.pipelines.size() ||
      cell.variant.size() != study.axes.size())
    return std::nullopt;
  for (std::size_t k = 0; k < study.axes.size(); ++k) {
    const auto& [title, values] = study.axes[k];
    const std::size_t value = index(values, cell.variant[k].second);
    if (cell.variant[k].first != title || value == values.size()) return std::nullopt;
    place[1] = place[1] * values.size() + value;
  }
  return place;
}

std::optional<CellAddress> find_cell(const StudyFile& study, const std::string& folder,
                                     const std::string& pipeline) {
  CellAddress cell{folder.substr(0, folder.find('@')), {}, pipeline};
  std::string rest = folder.substr(cell.name.size());
  for (const auto& [title, values] : study.axes) {
    const std::string opening = (cell.variant.empty() ? "@" : ",") + title + "=";
    if (!rest.starts_with(opening)) return std::nullopt;
    rest = rest.substr(opening.size());
    const std::string text = rest.substr(0, rest.find(','));
    for (std::size_t i = 0; i < values.size(); ++i)
      if (folder_text(values, i) == text) cell.variant.emplace_back(title, values[i]);
    rest = rest.substr(text.size());
  }
  if (!rest.empty() || !place_of(study, cell)) return std::nullopt;
  return cell;
}

}  // namespace delquad
