#include "experiments/sweep/verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/parallel.h"
#include "base/text.h"
#include "delquad/error.h"
#include "experiments/sweep/experiment_copy.h"
#include "experiments/sweep/folders.h"
#include "experiments/sweep/recorded_case.h"
#include "geometry/mesh/half_edges.h"
#include "io/digest.h"
#include "io/mesh_io.h"
#include "metrics/metrics.h"
#include "metrics/tables/json_problem.h"
#include "metrics/tables/result_records.h"
#include "metrics/tables/tables.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Lines = std::vector<std::string>;

/// Sums over the elements in the order of the file, not in that of the mesher; relative.
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

/// What the checks of a cell need later on: there may be many.
Json essence(const Json& record) {
  Json json = Json::object();
  for (const char* key : {"experiment", "case", "variant", "options", "digests", "metrics"})
    json[key] = record.value(key, Json());
  return json;
}

/// Fills in the record.
Lines check_record(VerifiedCell& cell) {
  const std::string text = file_bytes(cell.file);
  Lines wrong;
  if (!is_sealed(text))
    wrong.push_back(cell.file.string() + ": was changed: its digest is not that of its text");
  try {
    cell.record = Json::parse(text);
    std::ranges::move(check_files(cell), std::back_inserter(wrong));
    cell.record = essence(cell.record);
  } catch (const Json::exception& error) {
    wrong.push_back(json_problem(cell.file, "is no record of a cell", error));
    cell.has_mesh = false;
  }
  return wrong;
}

bool is_close(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) == std::isnan(b);
  return a == b || std::abs(a - b) <= kRounding * std::max(std::abs(a), std::abs(b));
}

/// Measures of the mesh that are not those of the record.
Lines check_measures(const VerifiedCell& cell, const Prepared* prepared) {
  const Mesh mesh = read_mesh(cell.file.parent_path() / "mesh.msh");
  const MeshMetrics now = prepared != nullptr ? prepared->metrics(mesh) : evaluate_metrics(mesh, nullptr);
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
      variants[Json::array({r.at("experiment"), r.at("case"), r.at("variant")}).dump()].push_back(&cell);
    }
  return variants;
}

/// Nothing where the model is not at hand.
std::optional<Prepared> prepare_variant(const VerifiedCell& cell, const fs::path& data) {
  try {
    const Experiment experiment = recorded_experiment(cell.record, results_of(cell.file), data);
    return prepare(recorded_case(cell.record, experiment, data));
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

/// Tables that are not those of the records.
Lines check_tables(const fs::path& folder, const Outcome& outcome) {
  const ScratchFolder scratch;
  write_tables(scratch.path(), outcome);
  Lines wrong;
  for (const std::string& name : result_files()) {
    if (!name.starts_with("table.") && !name.starts_with("pairs.")) continue;
    const fs::path file = folder / name;
    const bool expected = fs::exists(scratch.path() / name);
    if (expected && !fs::exists(file))
      wrong.push_back(file.string() + ": is missing");
    else if (expected != fs::exists(file) ||
             (expected && file_bytes(scratch.path() / name) != file_bytes(file)))
      wrong.push_back(file.string() + ": is not the table of these records");
  }
  return wrong;
}

/// What concerns no single cell.
Lines check_study(const fs::path& folder) {
  Lines wrong;
  if (!is_sealed(file_bytes(folder / "study.json")))
    wrong.push_back((folder / "study.json").string() + ": was changed: its digest is not that of its text");
  std::ranges::move(check_copies(folder), std::back_inserter(wrong));
  try {
    const StudyResults results = read_results(folder);
    if (const std::size_t there = results.records.size(); there < results.study.cells)
      wrong.push_back(fmt::format("{}: {} of {} cells have no result", folder.string(),
                                  results.study.cells - there, results.study.cells));
    std::ranges::move(check_tables(folder, make_tables(results)), std::back_inserter(wrong));
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

Lines damage_of_cell(const fs::path& record) {
  VerifiedCell cell{record, {}, false};
  return check_record(cell);
}

Verification verify_results(const fs::path& folder, const fs::path& data) {
  Verification result;
  std::vector<VerifiedCell> cells;
  for (const fs::path& file : record_files(folder)) cells.push_back({file, {}, false});
  if (cells.empty()) throw InputError(folder.string() + ": holds no record.json of an experiment");
  result.cells = cells.size();
  Lines of_study = check_study(folder);
  check_all(
      cells.size(), [&](std::size_t i) { return check_record(cells[i]); }, result.findings);
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
