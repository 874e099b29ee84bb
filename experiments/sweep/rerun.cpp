#include "experiments/sweep/rerun.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "delquad/error.h"
#include "experiments/sweep/cells.h"
#include "experiments/sweep/folders.h"
#include "experiments/sweep/recorded_case.h"
#include "io/digest.h"
#include "io/formats/msh.h"
#include "io/mesh_io.h"
#include "metrics/tables/json_problem.h"

namespace delquad {
namespace {

using Json = nlohmann::ordered_json;

/// Parts of a record that are no values: what determines them (compared apart), and what no two runs have in
/// common.
const std::vector<std::string> kNoValues = {"digest",      "key",
                                            "mesh_bytes",  "metrics_status",
                                            "case",        "pipeline",
                                            "status",      "model",
                                            "seed",        "variant",
                                            "peer",        "peer_file",
                                            "own_metrics", "experiment",
                                            "digests",     "files",
                                            "options",     "versions",
                                            "machine",     "started",
                                            "threads",     "peak_memory_bytes",
                                            "warnings"};

Json read_json(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw InputError(file.string() + ": cannot be read");
  try {
    Json json = Json::parse(in);
    if (json.at("status") != "ok")
      throw InputError(file.string() +
                       ": is of a cell that was not done: " + json.at("reason").get<std::string>());
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
  compare_objects("option", before.at("options"), now.at("options"), differences);
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
  Experiment experiment = recorded_experiment(record, results_of(file), data);
  experiment.words = experiment.find_pipelines({record.at("pipeline").get<std::string>()});
  const Word& word = experiment.words[0];
  const Case c = recorded_case(record, experiment, data);
  CellIdentity cell = identify(experiment, c, model_digest(c), word);

  const ScratchFolder scratch;
  const std::filesystem::path work = scratch.path() / "cell";
  MeshResult result = mesh_cell(c, word, cell.peer, work);
  measure_by_solvers(cell, result);
  measure_by_commands(cell, c, word.text, work, result);
  std::ostringstream mesh;
  write_msh(mesh, result.mesh);
  const Json now = Json::parse(run_record(c, word, result, &cell));
  return {record.at("digests").at("mesh") == digest(mesh.view()), compare_causes(record, now),
          compare_values(record, now)};
}

}  // namespace delquad
