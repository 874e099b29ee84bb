#include "experiments/sweep/recorded_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <system_error>

#include "delquad/error.h"
#include "experiments/sweep/experiment_copy.h"
#include "io/digest.h"

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
  throw InputError(
      fmt::format("{}: the model with the digest {} is neither here nor, by its name, below {} (--data){}",
                  file.string(), expected, data.string(), others));
}

}  // namespace

fs::path results_of(const fs::path& record_file) {
  return fs::absolute(record_file).lexically_normal().parent_path().parent_path().parent_path();
}

Experiment recorded_experiment(const Json& record, const fs::path& results, const fs::path& data) {
  const fs::path file = record.at("experiment").get<std::string>();
  if (const std::vector<std::string> wrong = check_copy(results, file); !wrong.empty())
    throw InputError(wrong[0]);
  Experiment experiment = Experiment::read(results / file, data);
  if (record.contains("peer")) {
    const auto name = record.at("pipeline").get<std::string>();
    if (std::ranges::find(experiment.peers, name, &Peer::name) == experiment.peers.end())
      experiment.add_peer_file((results / file).parent_path() / record.at("peer_file").get<std::string>());
  }
  experiment.max_elements = record.at("options").at("max_elements");
  return experiment;
}

Case recorded_case(const Json& record, const Experiment& experiment, const fs::path& data) {
  const auto name = record.at("case").get<std::string>();
  std::vector<std::pair<std::string, std::string>> variant;
  for (const auto& [title, value] : record.at("variant").items()) variant.emplace_back(title, value);
  const auto place = experiment.find_variant(name, variant);
  if (!place)
    throw InputError(fmt::format("{}: has no case '{}' with {}", experiment.file.string(), name,
                                 record.at("variant").dump()));
  Case c = experiment.read_variant((*place)[0], (*place)[1]);
  if (auto* file = std::get_if<ModelFile>(&c.model))
    file->path = find_model(file->path, record.at("digests").at("model"), data);
  return c;
}

}  // namespace delquad
