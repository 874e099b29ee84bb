// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "io/cases/case.h"
#include "io/cases/toml_reader.h"
#include "metrics/solve/solve.h"

// This header runs experiments that compute: meshes follow a known solution. Peers and experiments use it.

namespace delquad {

/// Reads the keys of CaseOfStudy. Throws InputError with file and line.
void read_study_keys(const TomlTable& table, Case& target);
/// Throws InputError, with file and line, for a case that does not go with loops.
void check_adapt(const Case& c);

/// Returns the solution of a case with its gradient; empty: none. `c` need not outlive it.
Solution solution_of(const Case& c);

/// Returns the mesh of `make` for the case or, if the case asks for a loop, the last mesh of the loop.
/// Poisson's equation is solved on each mesh, and its solution leads to the next one. Times are sums over all
/// meshes. A seed does not turn the domain, but asks for up to 3 % more quads. Throws as `make`.
MeshResult mesh_in_loop(const Case& c, const std::function<MeshResult(const Case&)>& make);

}  // namespace delquad
