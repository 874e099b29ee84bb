#pragma once

#include <filesystem>
#include <string>

#include "experiments/sweep/experiment.h"
#include "experiments/sweep/record.h"

namespace delquad {

/// Digest of what a case is made from: the bytes of its file, or its curves, loops and names.
std::string model_digest(const Case& c);

/// The cell of a pipeline on a variant of a case.
CellIdentity identify(const Experiment& experiment, const Case& c, const std::string& model_digest,
                      const Word& word);

/// Where the results of a cell lie, below the folder of the experiment.
std::filesystem::path cell_folder(const std::filesystem::path& folder, const Case& c, const Word& word);

}  // namespace delquad
