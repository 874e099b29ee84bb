// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/sweep/experiment.h"
#include "experiments/sweep/record.h"

// This header has the identity and the measures of a cell. Experiments and their repetition use it.

namespace delquad {

/// Returns the digest of the model of a case: the bytes of its file, or its curves, loops and names.
std::string model_digest(const Case& c);

/// Sets the text of parts outside of the program. The text counts like the bytes of the program: another text
/// makes cells outdated. Call this before cells are identified.
void set_added_parts(const std::string& text);

/// Returns the cell of a pipeline on a variant of a case.
CellIdentity identify(const Experiment& experiment, const Case& c, const std::string& model_digest,
                      const Pipeline& pipeline);

/// Returns the folder of the results of a cell, below the folder of the experiment.
std::filesystem::path cell_folder(const std::filesystem::path& folder, const Case& c,
                                  const Pipeline& pipeline);

/// Measures a cell by other programs in the folder `scratch`, which is made if necessary and gets mesh.msh
/// and their files. Adds values, failures and the time to the result. Returns the failures, a line each.
std::vector<std::string> measure_by_commands(const CellIdentity& cell, const Case& c,
                                             const std::string& pipeline,
                                             const std::filesystem::path& scratch, MeshResult& result);

/// Measures a cell by the solvers of its experiment. Adds values, failures and the time to the result.
/// Returns the failures, a line each.
std::vector<std::string> measure_by_solvers(const CellIdentity& cell, const Case& c, MeshResult& result);

}  // namespace delquad
