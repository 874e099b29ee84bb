#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/case.h"
#include "pipeline/stages.h"

namespace delquad {

/// A row of a published table.
struct PublishedRow {
  std::string name, source;
  std::map<std::string, double> values;  ///< by metric key
};

/// The column of a table that shows how long a step took.
struct StepTime {
  const char *key, *title;
  const char* step;  ///< as records call it; empty: all of these together
};
const std::vector<StepTime>& step_times_of_tables();

/// How a metric of one pipeline should relate to that of another on the same case.
struct ExpectedRatio {
  std::string metric, numerator, denominator;  ///< key and two words
  double expected = 1;
  std::string source;
};

/// Point sets on which the two Delaunay kernels are compared instead of meshing.
struct LinfStudy {
  std::vector<int> points;  ///< how many
  std::vector<int> seeds;
};

/// A file of experiments/: cases, the pipelines to run on each, and what was published.
struct Experiment {
  std::string title;
  std::filesystem::path file;
  std::vector<Case> cases;
  std::vector<Word> words;
  std::vector<PublishedRow> published;
  std::optional<ExpectedRatio> ratio;
  bool step_times = false;        ///< the table has a column for each step's time
  std::optional<LinfStudy> linf;  ///< then there are no cases
};

/// `data`: the folder that the models which cases call data are in. Throws InputError with file and line for
/// anything that is not as docs/experiments.md says.
Experiment read_experiment(const std::filesystem::path& file,
                           const std::filesystem::path& data = kDataFolder);

}  // namespace delquad
