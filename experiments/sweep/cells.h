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

/// What there is of the cell with this key in its folder: "done", "metric failed", "failed", "skipped" or
/// kNotApplicable by its record; "to do": there is none; "damaged": the record was changed or cut off, or its
/// mesh has not as many bytes as it says; "outdated": of another key. Costs little: meshes are not read.
std::string state_of_cell(const std::filesystem::path& folder, const std::string& key);
/// By its state, whether a cell has its mesh: measures by command may have failed.
bool has_mesh(const std::string& state);

}  // namespace delquad
