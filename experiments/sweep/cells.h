// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/sweep/experiment.h"
#include "experiments/sweep/record.h"

// This header has the identity and the measures of a cell. Experiments and their repetition use it.

namespace delquad {

/// Returns the digest of what a case is made from: the bytes of its file, or its curves, loops and names.
std::string model_digest(const Case& c);

/// Sets the text of parts that are in no file of the program. The text counts as the program's bytes do, and
/// cells made with another text are repeated. Call this before cells are identified.
void set_added_parts(const std::string& text);

/// Returns the cell of a pipeline on a variant of a case.
CellIdentity identify(const Experiment& experiment, const Case& c, const std::string& model_digest,
                      const Word& word);

/// Returns where the results of a cell lie, below the folder of the experiment.
std::filesystem::path cell_folder(const std::filesystem::path& folder, const Case& c, const Word& word);

/// Lets other programs take the measures of a cell, in the folder `scratch`. It is made if need be, and then
/// has mesh.msh and the files that they wrote. Adds values, failures and the time to the result. Returns the
/// failures, a line each.
std::vector<std::string> measure_by_commands(const CellIdentity& cell, const Case& c,
                                             const std::string& pipeline,
                                             const std::filesystem::path& scratch, MeshResult& result);

/// Solves on the mesh of a cell, as its experiment asks. Adds values, failures and the time to the result.
/// Returns what failed, a line each.
std::vector<std::string> measure_by_solvers(const CellIdentity& cell, const Case& c, MeshResult& result);

}  // namespace delquad
