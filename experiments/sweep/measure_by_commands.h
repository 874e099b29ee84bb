#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/sweep/record.h"

namespace delquad {

/// Lets other programs take the measures of a cell, in the folder `scratch`, which is made if need be and
/// then has mesh.msh and what they wrote. Adds values, failures and the time to the result. Returns what
/// failed, a line each.
std::vector<std::string> measure_by_commands(const CellIdentity& cell, const Case& c,
                                             const std::string& pipeline,
                                             const std::filesystem::path& scratch, MeshResult& result);

/// Solves on the mesh of a cell, as its experiment asks. Adds values, failures and the time to the result.
/// Returns what failed, a line each.
std::vector<std::string> measure_by_solvers(const CellIdentity& cell, MeshResult& result);

}  // namespace delquad
