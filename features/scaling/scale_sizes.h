// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "delquad/mesher.h"

// This header scales the sizes of a problem. The pipeline uses it for numbers of quads and `refine`.

namespace delquad {

/// Returns the problem, whose files are read, with a size that is `factor` times as large everywhere.
/// Distances stay, so that growth and gradation change with the size; curvature gets kLeastPerTurn elements
/// at least.
MeshProblem with_scaled_sizes(MeshProblem problem, double factor);

/// Returns the problem, whose files are read, with what `refine` asks for: sizes, numbers of edges, and
/// layers of the same thickness. Throws InputError where it cannot be.
MeshProblem refined(MeshProblem problem);

/// Throws InputError where lines are given, which say how long edges are; `asked` names what was asked for.
void require_free_sizes(const MeshProblem& problem, const std::string& asked);

}  // namespace delquad
