// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <sstream>

#include "base/located.h"
#include "base/parallel.h"
#include "base/system.h"
#include "base/text.h"
#include "delquad/error.h"
#include "experiments/sweep/cells.h"
#include "experiments/sweep/draw_figures.h"
#include "experiments/sweep/experiment_copy.h"
#include "experiments/sweep/recorded_cell.h"
#include "io/cases/problem_record.h"
#include "io/digest.h"
#include "io/formats/msh.h"
#include "io/mesh_io.h"
#include "metrics/tables/result_records.h"
#include "metrics/tables/tables.h"

namespace delquad {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Parts of a record that are no values: what determines them (compared apart), and what no two runs have in
/// common.
const std::vector<std::string> kNoValues = {
    "digest",     "key",     "metrics_status", "case",    "pipeline",          "status",
    "model",      "seed",    "variant",        "peer",    "peer_file",         "own_metrics",
    "experiment", "digests", "files",          "problem", "not_repeatable",    "record",
    "versions",   "machine", "started",        "threads", "peak_memory_bytes", "warnings",
    "solvers"};

bool is_time(const std::string& key) { return key.starts_with("seconds") || key.ends_with("seconds"); }

std::string shown(const Json& value) {
  constexpr std::size_t kLongest = 80;
  const std::string text =
      value.is_null() ? "none" : value.dump(-1, ' ', false, Json::error_handler_t::replace);
  return text.size() <= kLongest ? text
         : value.is_array()      ? fmt::format("{} values", value.size())
                                 : text.substr(0, kLongest) + "...";
}

/// Entries of two objects that are not the same, times excepted.
void compare_objects(const std::string& what, const Json& before, const Json& now,
                     std::vector<std::string>& differences) {
  const auto compare = [&](const std::string& key, const Json& value, const Json& other) {
    if (is_time(key) || value == other) return;
    if (value.is_object() && other.is_object())
      return compare_objects(what + " " + key, value, other, differences);
    differences.push_back(
        fmt::format("{} {}: {} in the record, {} now", what, key, shown(value), shown(other)));
  };
  for (const auto& [key, value] : before.items()) compare(key, value, now.value(key, Json()));
  for (const auto& [key, value] : now.items())
    if (!before.contains(key)) compare(key, Json(), value);
}

std::vector<std::string> compare_causes(const Json& before, const Json& now) {
  std::vector<std::string> differences;
  compare_objects("problem", before.at("problem"), now.at("problem"), differences);
  compare_objects("version", before.at("versions"), now.at("versions"), differences);
  compare_objects("peer", before.value("peer", Json::object()), now.value("peer", Json::object()),
                  differences);
  if (before.value("own_metrics", Json()) != now.value("own_metrics", Json()))
    differences.push_back("the measures by command, or files of theirs");
  const Json &old_digests = before.at("digests"), &digests = now.at("digests");
  if (old_digests.at("model") != digests.at("model")) differences.push_back("the model");
  if (old_digests.at("program") != digests.at("program")) differences.push_back("the program's bytes");
  return differences;
}

std::vector<std::string> compare_values(Json before, Json now) {
  for (const std::string& key : kNoValues) {
    before.erase(key);
    now.erase(key);
  }
  // Their reasons may hold times and folders.
  for (Json* json : {&before, &now})
    if (json->contains("failed_metrics"))
      for (auto& [key, reason] : (*json)["failed_metrics"].items()) reason = true;
  std::vector<std::string> differences;
  compare_objects("value", before, now, differences);
  return differences;
}

Rerun rerun(const Json& record, const RecordedCell& recorded) {
  const Pipeline& pipeline = recorded.experiment.parsed[0];
  const Case& c = recorded.c;
  const CellIdentity cell = identify(recorded.experiment, c, model_digest(c), pipeline);
  const TemporaryFolder scratch;
  const std::filesystem::path work = scratch.path() / "cell";
  MeshResult result = mesh_cell(c, pipeline, cell.peer, work);
  measure_by_solvers(cell, c, result);
  measure_by_commands(cell, c, pipeline.text, work, result);
  std::ostringstream mesh;
  write_msh(mesh, result.mesh);
  const Json now = Json::parse(run_record(c, pipeline, result, &cell));
  return {record.at("digests").at("mesh") == digest(mesh.view()), compare_causes(record, now),
          compare_values(record, now)};
}

}  // namespace

Rerun rerun_record(const std::filesystem::path& file, const std::filesystem::path& data) {
  const Json record = read_record_file(file);
  if (!record.contains("experiment"))
    refuse("{0}: is the record of one mesh: 'delquad mesh {0} -o FILE' makes it again", file.string());
  try {
    if (record.at("status") != "ok")
      refuse("{}: is the record of a cell that failed: {}", file.string(),
             record.at("reason").get<std::string>());
    return rerun(record, recorded_cell(record, file, data));
  } catch (const Json::exception& error) {
    throw InputError(json_problem(file, "is no record of a cell of an experiment", error));
  }
}

namespace {

using Lines = std::vector<std::string>;

/// Sums over the elements in the order of the file, not in the order of the mesher; relative.
constexpr double kRounding = 1e-9;

/// A cell as its record tells it.
struct VerifiedCell {
  fs::path file;
  Json record;
  bool has_mesh = false;  ///< which is as it was written
};

Lines check_files(VerifiedCell& cell) {
  Lines wrong;
  const fs::path folder = cell.file.parent_path();
  for (const auto& [name, mark] : cell.record.at("files").items()) {
    const std::string how = difference(folder / name, {mark.at("bytes"), mark.at("digest")});
    if (!how.empty()) wrong.push_back((folder / name).string() + ": " + how);
    if (name == "mesh.msh") cell.has_mesh = how.empty();
  }
  return wrong;
}

/// Whether a record lies in the folder of another cell, or is of another problem.
Lines check_place(const VerifiedCell& cell, const StudyFile& study) {
  const fs::path folder = fs::absolute(cell.file).lexically_normal().parent_path();
  const std::string variant = folder.parent_path().filename().string(), pipeline = folder.filename().string();
  CellAddress address{cell.record.at("case"), {}, cell.record.at("pipeline")};
  for (const auto& [title, value] : cell.record.at("variant").items())
    address.variant.emplace_back(title, value);
  const auto at = find_cell(study, variant, pipeline);
  const auto now = study.problems.find(variant);
  const std::string problem = ProblemRecord{cell.record.at("problem"), {}}.digest();
  if (pipeline == address.pipeline && variant.substr(0, variant.find('@')) == address.name &&
      (!at || at->variant == address.variant)) {
    if (now == study.problems.end() || std::ranges::count(now->second, problem) > 0) return {};
    return {cell.file.string() + ": has another problem than the experiment has now: run it again"};
  }
  return {fmt::format("{}: is the record of {} {} {}, in the folder of another cell", cell.file.string(),
                      address.name, cell.record.at("variant").dump(), address.pipeline)};
}

/// Returns the parts of a record that later checks need. There may be many records.
Json comparable_part(const Json& record) {
  Json json = Json::object();
  for (const char* key : {"experiment", "case", "variant", "pipeline", "model", "problem", "digests",
                          "metrics", "peer", "peer_file"})
    if (record.contains(key)) json[key] = record[key];
  return json;
}

/// Fills in the record.
Lines check_record(VerifiedCell& cell, const StudyFile& study) {
  const std::string text = file_bytes(cell.file);
  Lines wrong;
  if (!is_sealed(text))
    wrong.push_back(cell.file.string() + ": was changed: its digest does not fit its text");
  try {
    cell.record = Json::parse(text);
    located(cell.file.string(), [&] { check_record_version(cell.record.value("record", 1)); });
    std::ranges::move(check_files(cell), std::back_inserter(wrong));
    std::ranges::move(check_place(cell, study), std::back_inserter(wrong));
    cell.record = comparable_part(cell.record);
  } catch (const Json::exception& error) {
    wrong.push_back(json_problem(cell.file, "is no record of a cell", error));
    cell = {cell.file, {}, false};
  } catch (const InputError& error) {
    wrong.emplace_back(error.what());
    cell = {cell.file, {}, false};
  }
  return wrong;
}

bool is_close(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) == std::isnan(b);
  return a == b || std::abs(a - b) <= kRounding * std::max(std::abs(a), std::abs(b));
}

/// As they were measured, of a peer or of a pipeline.
MeshMetrics metrics_of(const Json& record, const Prepared& prepared, const Mesh& mesh) {
  return record.contains("peer") ? prepared.measure(mesh).metrics
                                 : prepared.metrics(mesh, record.at("pipeline").get<std::string>());
}

/// Measures of the mesh that differ from the record.
Lines check_measures(const VerifiedCell& cell, const Prepared* prepared) {
  const Mesh mesh = read_mesh(cell.file.parent_path() / "mesh.msh");
  const MeshMetrics now =
      prepared != nullptr ? metrics_of(cell.record, *prepared, mesh) : evaluate_metrics(mesh, nullptr);
  Lines wrong;
  for (const auto& [key, value] : cell.record.at("metrics").items()) {
    const auto at = now.values.find(key);
    const bool is_known = at != now.values.end() && (prepared != nullptr || !std::isnan(at->second));
    const double recorded = value.is_null() ? std::nan("") : value.get<double>();
    if (is_known && !is_close(recorded, at->second))
      wrong.push_back(fmt::format("{}: {} is {} in the record, {} by its mesh", cell.file.string(), key,
                                  recorded, at->second));
  }
  return wrong;
}

/// Cells of a variant: their fields are made once.
using Variant = std::vector<const VerifiedCell*>;

std::map<std::string, Variant> by_variant(const std::vector<VerifiedCell>& cells) {
  std::map<std::string, Variant> variants;
  for (const VerifiedCell& cell : cells)
    if (cell.has_mesh) {
      const Json& r = cell.record;
      variants[Json::array({r.at("case"), r.at("problem")}).dump()].push_back(&cell);
    }
  return variants;
}

/// Returns nothing if the model is not at hand. Meshes of a loop, and of a number of quads, have sizes from
/// meshes that are gone.
std::optional<Prepared> prepare_variant(const VerifiedCell& cell, const fs::path& data) {
  try {
    const Case c = recorded_cell(cell.record, cell.file, data).c;
    return c.adapt || c.quads ? std::nullopt : std::optional(prepare(c));
  } catch (const InputError&) {
    return std::nullopt;
  }
}

Lines check_variant(const Variant& variant, const fs::path& data) {
  Lines wrong;
  try {
    const auto prepared = prepare_variant(*variant[0], data);
    for (const VerifiedCell* cell : variant)
      std::ranges::move(check_measures(*cell, prepared ? &*prepared : nullptr), std::back_inserter(wrong));
  } catch (const Json::exception& error) {
    wrong.push_back(json_problem(variant[0]->file, "is no record of a cell", error));
  } catch (const InputError& error) {
    wrong.emplace_back(error.what());
  }
  return wrong;
}

/// Figures that the tables in `scratch` do not make. Files of others stay empty there.
Lines check_figures(const fs::path& folder, const fs::path& scratch, std::string& undrawn) {
  std::set<std::string> names;
  if (fs::is_directory(folder / kFigures))
    for (const auto& file : fs::directory_iterator(folder / kFigures))
      names.insert(file.path().filename().string());
  if (names.empty()) return {};
  fs::create_directory(scratch / kFigures);
  for (const std::string& name : names) write_text_file(scratch / kFigures / name, "");
  undrawn = draw_figures({scratch});
  if (!undrawn.empty()) return {};
  Lines wrong;
  for (const std::string& name : names) {
    const fs::path file = folder / kFigures / name, expected = scratch / kFigures / name;
    const std::string bytes = fs::exists(expected) ? file_bytes(expected) : "";
    if (!fs::exists(expected) || (!bytes.empty() && bytes != file_bytes(file)))
      wrong.push_back(file.string() + ": is not what these records make with this version of matplotlib");
  }
  return wrong;
}

/// Tables and figures that the records do not make.
Lines check_tables(const fs::path& folder, const Outcome& outcome, std::string& undrawn) {
  const TemporaryFolder scratch;
  write_tables(scratch.path(), outcome);
  std::set<fs::path> names;
  for (const std::string& name : result_files())
    if (fs::path(name).has_extension() && name != "study.json") names.insert(name);
  for (const auto& file : fs::recursive_directory_iterator(scratch.path()))
    if (file.is_regular_file()) names.insert(file.path().lexically_relative(scratch.path()));
  Lines wrong;
  for (const fs::path& name : names) {
    const fs::path file = folder / name, expected = scratch.path() / name;
    if (fs::exists(expected) && !fs::exists(file))
      wrong.push_back(file.string() + ": is missing");
    else if (fs::exists(file) && (!fs::exists(expected) || file_bytes(expected) != file_bytes(file)))
      wrong.push_back(file.string() + ": is not what these records make");
  }
  std::ranges::move(check_figures(folder, scratch.path(), undrawn), std::back_inserter(wrong));
  return wrong;
}

/// Checks the files that belong to no single cell.
Lines check_study(const fs::path& folder, std::string& undrawn) {
  Lines wrong;
  if (!is_sealed(file_bytes(folder / "study.json")))
    wrong.push_back((folder / "study.json").string() + ": was changed: its digest does not fit its text");
  std::ranges::move(check_copies(folder), std::back_inserter(wrong));
  try {
    const StudyResults results = read_results(folder);
    if (const std::size_t there = results.records.size(); there < results.study.cells)
      wrong.push_back(fmt::format("{}: {} of {} cells have no result", folder.string(),
                                  results.study.cells - there, results.study.cells));
    std::ranges::move(check_tables(folder, make_tables(results), undrawn), std::back_inserter(wrong));
  } catch (const InputError& error) {
    wrong.emplace_back(error.what());
  }
  return wrong;
}

/// Runs `check` for each of `n`, and puts the findings together in their order.
template <class Check>
void check_all(std::size_t n, Check check, Lines& findings) {
  std::vector<Lines> wrong(n);
  parallel_for(n, [&](std::size_t i) { wrong[i] = check(i); });
  for (Lines& lines : wrong) std::ranges::move(lines, std::back_inserter(findings));
}

}  // namespace

Lines damage_of_cell(const fs::path& record, const StudyFile& study) {
  VerifiedCell cell{record, {}, false};
  return check_record(cell, study);
}

Verification verify_results(const fs::path& folder, const fs::path& data) {
  Verification result;
  std::vector<VerifiedCell> cells;
  for (const fs::path& file : record_files(folder)) cells.push_back({file, {}, false});
  if (cells.empty())
    throw InputError(folder.string() + ": holds no record.json: expected the folder of 'delquad run -o'");
  result.cells = cells.size();
  Lines of_study = check_study(folder, result.undrawn);
  StudyFile study;
  try {
    study = read_study(folder).value_or(study);
  } catch (const InputError&) {  // as check_study() says
  }
  check_all(
      cells.size(), [&](std::size_t i) { return check_record(cells[i], study); }, result.findings);
  std::vector<Variant> variants;
  for (auto& [name, variant] : by_variant(cells)) {
    result.measured += variant.size();
    variants.push_back(std::move(variant));
  }
  check_all(
      variants.size(), [&](std::size_t i) { return check_variant(variants[i], data); }, result.findings);
  std::ranges::move(of_study, std::back_inserter(result.findings));
  return result;
}

}  // namespace delquad
