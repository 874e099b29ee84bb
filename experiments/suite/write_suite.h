#pragma once

#include <filesystem>

#include "experiments/sweep/experiment.h"

namespace delquad {

/// Writes all that other programs and ours need to mesh the suite's cases to a folder, which is made: the
/// models (.toml, .step, .obj), of planar cases the boundary as lines (NAME_1.msh, ...), cases.json with the
/// sizes, and suite.toml, the experiment. Throws InputError when something cannot be written, and when a
/// model is not the one that the list has the SHA-256 of: results could not be compared.
void write_suite(const std::filesystem::path& folder);

/// The models and suite.toml alone, as an experiment with one case for each model and size, in their order.
Experiment write_suite_experiment(const std::filesystem::path& folder);

}  // namespace delquad
