#include "experiments/sweep/verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <sstream>
#include <system_error>

#include "base/located.h"
#include "base/parallel.h"
#include "base/system.h"
#include "base/text.h"
#include "delquad/error.h"
#include "experiments/sweep/cells.h"
#include "experiments/sweep/draw_figures.h"
#include "experiments/sweep/experiment.h"
#include "experiments/sweep/experiment_copy.h"
#include "experiments/sweep/folders.h"
#include "geometry/mesh/half_edges.h"
#include "io/digest.h"
#include "io/formats/msh.h"
#include "io/mesh_io.h"
#include "metrics/metrics.h"
#include "metrics/tables/result_records.h"
#include "metrics/tables/study_file.h"
#include "metrics/tables/tables.h"

namespace delquad {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Files of this name in a folder and in those inside it, in the order of their paths.
std::vector<fs::path> files_named(const fs::path& name, const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::recursive_directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (at->path().filename() == name && at->is_regular_file(error)) found.push_back(at->path());
  std::ranges::sort(found);
  return found;
}

fs::path find_model(const fs::path& file, const std::string& expected, const fs::path& data) {
  std::string others;
  std::error_code unknown;
  std::vector<fs::path> places = files_named(file.filename(), data);
  if (fs::is_regular_file(file, unknown)) places.insert(places.begin(), file);
  for (const fs::path& place : places) {
    const std::string found = mark_of(place).digest;
    if (found == expected) return place;
    others += fmt::format("; {} has the digest {}", place.string(), found);
  }
  refuse("{}: the model with the digest {} is neither here nor, by its name, below {} (--data){}",
         file.string(), expected, data.string(), others);
}

/// The folder of the results that a cell's record belongs to.
fs::path results_of(const fs::path& record_file) {
  return fs::absolute(record_file).lexically_normal().parent_path().parent_path().parent_path();
}

/// The experiment that a record was made from, by its copy in the folder `results`. Throws InputError when it
/// was changed or is not there.
Experiment recorded_experiment(const Json& record, const fs::path& results, const fs::path& data) {
  const fs::path file = record.at("experiment").get<std::string>();
  if (const std::vector<std::string> wrong = check_copy(results, file); !wrong.empty())
    throw InputError(wrong[0]);
  Experiment experiment = Experiment::read(results / file, data);
  experiment.max_elements = record.at("problem").at("max_elements");
  return experiment;
}

/// The variant of a case that a record is of. A model that is a file is that with the digest of the record:
/// at its place, or anywhere below `data` by its name. Throws InputError, naming file and digest, when there
/// is none, and when the experiment has no such variant.
Case recorded_case(const Json& record, const Experiment& experiment, const fs::path& data) {
  const auto name = record.at("case").get<std::string>();
  std::vector<std::pair<std::string, std::string>> variant;
  for (const auto& [title, value] : record.at("variant").items()) variant.emplace_back(title, value);
  const auto place = experiment.find_variant(name, variant);
  if (!place)
    refuse("{}: has no case '{}' with {}", experiment.file.string(), name, record.at("variant").dump());
  Case c = experiment.read_variant((*place)[0], (*place)[1]);
  if (auto* file = std::get_if<ModelFile>(&c.model))
    file->path = find_model(file->path, record.at("digests").at("model"), data);
  return c;
}

using Json = nlohmann::ordered_json;

/// Parts of a record that are no values: what determines them (compared apart), and what no two runs have in
/// common.
const std::vector<std::string> kNoValues = {
    "digest",  "key",     "mesh_bytes",        "metrics_status", "case",      "pipeline",    "status",
    "model",   "seed",    "variant",           "peer",           "peer_file", "own_metrics", "experiment",
    "digests", "files",   "problem",           "not_repeatable", "record",    "versions",    "machine",
    "started", "threads", "peak_memory_bytes", "warnings"};

Json read_json(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw InputError(file.string() + ": cannot be read");
  try {
    Json json = Json::parse(in);
    located(file.string(), [&] { check_record_version(json.value("record", 1)); });
    if (json.at("status") != "ok")
      refuse("{}: is of a cell that was not done: {}", file.string(), json.at("reason").get<std::string>());
    json.at("digests").at("mesh");
    return json;
  } catch (const Json::exception& error) {
    throw InputError(json_problem(file, "is no record of an experiment's cell", error));
  }
}

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
  if (before.at("seed") != now.at("seed")) differences.push_back("the seed");
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

}  // namespace

Rerun rerun_record(const std::filesystem::path& file, const std::filesystem::path& data) {
  const Json record = read_json(file);
  const auto name = record.at("pipeline").get<std::string>();
  Experiment experiment = recorded_experiment(record, results_of(file), data);
  if (record.contains("peer") &&
      std::ranges::find(experiment.peers, name, &Peer::name) == experiment.peers.end())
    experiment.add_peer_file(experiment.file.parent_path() / record.at("peer_file").get<std::string>());
  experiment.words = experiment.find_pipelines({name});
  const Word& word = experiment.words[0];
  const Case c = recorded_case(record, experiment, data);
  CellIdentity cell = identify(experiment, c, model_digest(c), word);

  const TemporaryFolder scratch;
  const std::filesystem::path work = scratch.path() / "cell";
  MeshResult result = mesh_cell(c, word, cell.peer, work);
  measure_by_solvers(cell, c, result);
  measure_by_commands(cell, c, word.text, work, result);
  std::ostringstream mesh;
  write_msh(mesh, result.mesh);
  const Json now = Json::parse(run_record(c, word, result, &cell));
  return {record.at("digests").at("mesh") == digest(mesh.view()), compare_causes(record, now),
          compare_values(record, now)};
}

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

/// Whether a record lies in the folder of another cell.
Lines check_place(const VerifiedCell& cell) {
  const fs::path folder = fs::absolute(cell.file).lexically_normal().parent_path();
  const std::string variant = folder.parent_path().filename().string(), pipeline = folder.filename().string();
  CellAddress address{cell.record.at("case"), {}, cell.record.at("pipeline")};
  for (const auto& [title, value] : cell.record.at("variant").items())
    address.variant.emplace_back(title, value);
  bool is_right = pipeline == address.pipeline && variant.substr(0, variant.find('@')) == address.name;
  try {
    const auto study = read_study(results_of(cell.file));
    const auto at = study ? find_cell(*study, variant, pipeline) : std::nullopt;
    is_right = is_right && (!at || at->variant == address.variant);
  } catch (const InputError&) {  // as check_study() says
  }
  if (is_right) return {};
  return {fmt::format("{}: is the record of {} {} {}, in the folder of another cell", cell.file.string(),
                      address.name, cell.record.at("variant").dump(), address.pipeline)};
}

/// What the checks of a cell need later on: there may be many.
Json essence(const Json& record) {
  Json json = Json::object();
  for (const char* key :
       {"experiment", "case", "variant", "pipeline", "peer", "problem", "digests", "metrics"})
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
    std::ranges::move(check_place(cell), std::back_inserter(wrong));
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

/// As they were measured, of a peer or of a word.
MeshMetrics metrics_of(const Json& record, const Prepared& prepared, const Mesh& mesh) {
  return record.at("peer").is_null() ? prepared.metrics(mesh, record.at("pipeline").get<std::string>())
                                     : prepared.measure(mesh).metrics;
}

/// Measures of the mesh that are not those of the record.
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
      variants[Json::array({r.at("experiment"), r.at("case"), r.at("variant")}).dump()].push_back(&cell);
    }
  return variants;
}

/// Nothing where the model is not at hand, and in a loop, whose sizes come from meshes that are gone.
std::optional<Prepared> prepare_variant(const VerifiedCell& cell, const fs::path& data) {
  try {
    const Experiment experiment = recorded_experiment(cell.record, results_of(cell.file), data);
    const Case c = recorded_case(cell.record, experiment, data);
    return c.adapt ? std::nullopt : std::optional(prepare(c));
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

/// What concerns no single cell.
Lines check_study(const fs::path& folder, std::string& undrawn) {
  Lines wrong;
  if (!is_sealed(file_bytes(folder / "study.json")))
    wrong.push_back((folder / "study.json").string() + ": was changed: its digest is not that of its text");
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
  Lines of_study = check_study(folder, result.undrawn);
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
