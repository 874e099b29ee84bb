#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/sweep/experiment.h"

namespace delquad {

/// What a folder of results says of its experiment, besides the records of its cells: study.json.
struct StudyFile {
  std::string title, experiment;  ///< the latter: name of the experiment's file, without folder and extension
  std::vector<std::string> cases, pipelines;
  /// What varies, in its order, with its values.
  std::vector<std::pair<std::string, std::vector<std::string>>> axes;
  std::size_t cells = 0;  ///< that the experiment has
  std::vector<PublishedRow> published;
  std::optional<ExpectedRatio> ratio;
  bool step_times = false;
  int repeat_times = 0;              ///< as in Experiment
  std::vector<std::string> columns;  ///< as in Experiment
  std::optional<CorrelationRequest> correlation = {};
  /// case -> pipeline -> name of the published row beside it
  std::map<std::string, std::map<std::string, std::string>> compare;
};

StudyFile describe(const Experiment& experiment);
/// Throws InputError when it cannot be written.
void write_study(const std::filesystem::path& folder, const StudyFile& study);
/// Nothing when there is none; throws InputError when it is no such file.
std::optional<StudyFile> read_study(const std::filesystem::path& folder);

/// Which cell of an experiment.
struct CellAddress {
  std::string name;                                          ///< of the case
  std::vector<std::pair<std::string, std::string>> variant;  ///< what varies, by title, with its value
  std::string pipeline;
};
/// Where the cell stands among those of the experiment: case, variant and pipeline. Nothing: it has none
/// such.
std::optional<std::array<std::size_t, 3>> place_of(const StudyFile& study, const CellAddress& cell);
/// The cell whose results lie in the folder of this name ("disc@seed=2"), with this pipeline; nothing where
/// the experiment has none such.
std::optional<CellAddress> find_cell(const StudyFile& study, const std::string& folder,
                                     const std::string& pipeline);

}  // namespace delquad
