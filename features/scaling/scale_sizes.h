// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "delquad/mesher.h"

// This header scales the sizes of a problem. The pipeline uses it for numbers of quads and `refine`.

namespace delquad {

/// Returns the problem with sizes that are `factor` (above 0) times as large everywhere; its files have been
/// read. Distances stay, so growth and gradation change with the size. Curvature keeps at least kLeastPerTurn
/// elements.
MeshProblem with_scaled_sizes(MeshProblem problem, double factor);

/// Returns the problem with the sizes, numbers of edges and layers that `refine` asks for; its files have
/// been read. The thickness of layers stays. Throws InputError if `refine` is not finite and above 0, beside
/// a number of quads, and as require_free_sizes().
MeshProblem refined(MeshProblem problem);

/// Throws InputError for given lines, whose lengths are the sizes; `asked` names the request.
void require_free_sizes(const MeshProblem& problem, const std::string& asked);

}  // namespace delquad
