#include "experiments/sweep/peer_reference.h"

#include <fmt/format.h>

#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/activity.h"
#include "base/calibration.h"
#include "delquad/error.h"
#include "experiments/sweep/folders.h"
#include "experiments/sweep/process_tree.h"

namespace delquad {
namespace {

/// The record of the cell, if it is of the same case, options and program.
std::optional<nlohmann::json> valid_record(const ReferenceCell& cell) {
  if (cell.folder.empty()) return std::nullopt;
  std::ifstream in(cell.folder / "record.json");
  const nlohmann::json json = nlohmann::json::parse(in, nullptr, false);
  if (!json.is_object() || json.value("key", "") != cell.key) return std::nullopt;
  return json;
}

/// Found in a process of its own: whatever becomes of that, it is not the peer that failed.
std::optional<double> quads_of_word(const Prepared& prepared, const std::string& word) {
  const DoingStage counting("our word that the peer is calibrated to");
  const ScratchFolder scratch;
  const std::filesystem::path file = scratch.path() / "quads";
  std::optional<ProcessFailure> failure;
  std::optional<Job> job(std::in_place);
  job->work = [&] { std::ofstream(file) << fmt::format("{}", count_of_quads(mesh(prepared, word).mesh)); };
  job->failed = [&](const ProcessFailure& why) { failure = why; };
  run_jobs([&] { return std::exchange(job, std::nullopt); }, {});
  if (failure && failure->kind == "bad input") return std::nullopt;
  if (failure)
    throw JobFailed(
        {failure->kind, fmt::format("our word {}, whose number of quads it was to have, failed: {}; "
                                    "the peer was not run",
                                    word, failure->reason)});
  double quads = 0;
  if (!(std::ifstream(file) >> quads)) throw InputError(file.string() + ": cannot be written");
  return quads;
}

}  // namespace

std::optional<double> reference_quads(const Prepared& prepared, const std::string& word,
                                      const ReferenceCell& cell) {
  if (const auto record = valid_record(cell)) {
    if (record->value("status", "") != "ok") return std::nullopt;
    const nlohmann::json& metrics = record->at("metrics");
    return metrics.at("n_quads").get<double>() + 0.5 * metrics.at("n_triangles").get<double>();
  }
  return quads_of_word(prepared, word);
}

Prepared prepare_scaled(const Prepared& prepared, double scale) {
  MeshProblem problem = prepared.problem();
  problem.quads.reset();
  problem.refine = 1 / scale;
  return prepare(std::move(problem));
}

}  // namespace delquad
