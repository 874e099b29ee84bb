// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "io/cases/case.h"
#include "io/cases/toml_reader.h"
#include "metrics/solve/solve.h"

/// This header runs experiments that compute: meshes follow a known solution. Peers and experiments use it.

namespace delquad {

/// Reads the keys of CaseOfStudy. Throws InputError with file and line.
void read_study_keys(const TomlTable& table, Case& target);
/// Checks a case, since loops do not go with everything. Throws InputError with file and line.
void check_adapt(const Case& c);

/// Returns its solution with the gradient; empty where it has none. `c` need not outlive it.
Solution solution_of(const Case& c);

/// Returns the mesh that `make` makes of the case. If the case asks for a loop, returns the last mesh of the
/// loop. Poisson's equation is solved on each mesh, and its solution asks for the next one. Times are sums
/// over all meshes. A seed does not turn the domain, but asks for up to 3 % more quads.
MeshResult mesh_in_loop(const Case& c, const std::function<MeshResult(const Case&)>& make);

}  // namespace delquad
