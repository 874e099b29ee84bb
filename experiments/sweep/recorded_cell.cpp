// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/recorded_cell.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "base/located.h"
#include "base/text.h"
#include "delquad/error.h"
#include "io/cases/read_record.h"
#include "io/digest.h"
#include "metrics/tables/result_records.h"

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

/// At its place, beside the record, or below the folders; the last folder is the data folder.
fs::path find_file(const fs::path& file, const std::string& expected, const fs::path& record,
                   const std::vector<fs::path>& folders) {
  std::string others;
  const auto is_it = [&](const fs::path& place) {
    const std::string found = mark_of(place).digest;
    if (found != expected) others += fmt::format("; {} has the digest {}", place.string(), found);
    return found == expected;
  };
  std::error_code unknown;
  for (const fs::path& place : {file, record.parent_path() / file.filename()})
    if (fs::is_regular_file(place, unknown) && is_it(place)) return place;
  for (const fs::path& folder : folders)
    for (const fs::path& place : files_named(file.filename(), folder))
      if (is_it(place)) return place;
  const fs::path& data = folders.back();
  refuse(
      "{}: the file with the digest {} is neither here nor, by its name, beside the record{}{}: expected it "
      "there",
      file.string(), expected, data.empty() ? "" : fmt::format(" or below {} (--data)", data.string()),
      others);
}

/// Reads the peer, and the measures by other programs.
void read_programs(const Json& record, const RecordReader& reader, Experiment& experiment) {
  const fs::path folder = experiment.file.parent_path();
  if (record.contains("peer")) {
    Peer& peer = experiment.peers.emplace_back();
    reader.object(record["peer"], peer);
    peer.file = folder / record.at("peer_file").get<std::string>();
    peer.folder = peer.file.parent_path();
  }
  for (const Json& metric : record.value("own_metrics", Json::array())) {
    if (!metric.contains("command")) continue;
    MetricCommand& command = experiment.metrics.emplace_back();
    reader.object(metric, command);
    command.folder = folder;
  }
  experiment.solvers = record.value("solvers", std::vector<std::string>());
}

}  // namespace

fs::path results_of(const fs::path& record_file) {
  return fs::absolute(record_file).lexically_normal().parent_path().parent_path().parent_path();
}

Json read_record_file(const fs::path& file) {
  try {
    Json json = Json::parse(file_bytes(file));
    located(file.string(), [&] { check_record_version(json.value("record", 1)); });
    return json;
  } catch (const Json::exception& error) {
    throw InputError(json_problem(file, "is no record", error));
  }
}

RecordedCell recorded_cell(const Json& record, const fs::path& file, const fs::path& data) try {
  RecordedCell cell{{}, {}, record.contains("experiment")};
  Case& c = cell.c;
  c.name = record.at("case");
  c.where = file.string();
  c.data_folder = data;
  const std::string model = record.at("model");
  std::vector<fs::path> folders = {data};
  if (cell.is_of_experiment) {
    cell.experiment.file = results_of(file) / record["experiment"].get<std::string>();
    folders.insert(folders.begin(), results_of(file) / "experiment");
  }
  const RecordReader reader([&](const fs::path& name, const std::string& digest) {
    return find_file(name.empty() ? fs::path(model) : name, digest, file, folders);
  });
  located(file.string(), [&] {
    reader.object<MeshProblem>(record.at("problem"), c);
    reader.object<CaseOfStudy>(record.at("problem"), c);
  });
  if (auto* planar = std::get_if<PlanarModel>(&c.model)) planar->source = model;
  for (const auto& [title, value] : record.at("variant").items()) c.variant.emplace_back(title, value);
  read_programs(record, reader, cell.experiment);
  const auto pipeline = record.at("pipeline").get<std::string>();
  cell.experiment.parsed = {cell.experiment.peers.empty() ? parse_pipeline(pipeline, pipeline_start(c.model))
                                                          : Pipeline{pipeline, {}, PatchForm::kQuads}};
  return cell;
} catch (const Json::exception& error) {
  throw InputError(json_problem(file, "is no record of a mesh", error));
}

}  // namespace delquad
