#include "sweep/rerun.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cases/problem.h"
#include "delquad/error.h"
#include "io/mesh_io.h"
#include "mesher/runner.h"
#include "sweep/cells.h"
#include "sweep/digest.h"

namespace delquad {
namespace {

using Json = nlohmann::ordered_json;

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
    throw InputError(
        fmt::format("{}: is no record of an experiment's cell: {}", file.string(), error.what()));
  }
}

/// Entries of an object that are not the same in both.
void compare_objects(const std::string& what, const Json& before, const Json& now,
                     std::vector<std::string>& differences) {
  for (const auto& [key, value] : before.items()) {
    const Json other = now.value(key, Json());
    if (value.is_object() && other.is_object())
      compare_objects(what + " " + key, value, other, differences);
    else if (other != value)
      differences.push_back(
          fmt::format("{} {}: {} in the record, {} now", what, key, value.dump(), other.dump()));
  }
}

/// Removed at the end.
struct TemporaryFolder {
  std::filesystem::path path;
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "delquad-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw InputError(pattern + ": cannot be made");
    path = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
};

}  // namespace

Rerun rerun_record(const std::filesystem::path& file) {
  const Json record = read_json(file);
  Experiment experiment =
      Experiment::read(record.at("experiment").get<std::string>(), record.at("data").get<std::string>());
  const auto pipeline = record.at("pipeline").get<std::string>();
  if (record.contains("peer") &&
      std::ranges::find(experiment.peers, pipeline, &Peer::name) == experiment.peers.end())
    experiment.add_peer_file(record.at("peer_file").get<std::string>());  // of --peer
  experiment.words = experiment.find_pipelines({pipeline});
  experiment.max_elements = record.at("options").at("max_elements");
  const auto place = record.at("place").get<std::array<std::size_t, 3>>();
  const auto name = record.at("case").get<std::string>();
  if (place[0] >= experiment.n_cases() || place[1] >= experiment.n_variants() ||
      experiment.read_variant(place[0], place[1]).name != name)
    throw InputError(fmt::format("{}: {} has no case '{}' in this place any more", file.string(),
                                 experiment.file.string(), name));
  const Case c = experiment.read_variant(place[0], place[1]);

  Rerun rerun;
  const CellIdentity now = identify(experiment, c, model_digest(c), {place[0], place[1], 0});
  compare_objects("option", record.at("options"), Json::parse(options_record(c)), rerun.differences);
  compare_objects("version", record.at("versions"), Json::parse(versions_record()), rerun.differences);
  if (now.peer != nullptr)
    compare_objects("peer", record.at("peer"), Json::parse(peer_record(*now.peer, now.peer_version)),
                    rerun.differences);
  const Json& digests = record.at("digests");
  if (digests.at("model") != now.model_digest) rerun.differences.push_back("the model");
  if (digests.at("program") != now.program_digest) rerun.differences.push_back("the program's bytes");
  if (record.at("seed") != c.seed) rerun.differences.push_back("the seed");

  const TemporaryFolder scratch;
  const PreparedProblem prepared = prepare_case(c);
  const RunResult result = now.peer != nullptr ? run_peer(*now.peer, c, prepared, pipeline, scratch.path)
                                               : run_word(prepared, experiment.words[0]);
  std::ostringstream mesh;
  write_msh(mesh, result.mesh);
  rerun.same_mesh = digests.at("mesh") == digest(mesh.view());
  return rerun;
}

}  // namespace delquad
