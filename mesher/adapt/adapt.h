// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "delquad/adapt.h"

// This header has the parts of adaptation. The files of this folder use it.

namespace delquad {

/// Returns the integral of sqrt(det M) over a planar mesh, from M at its points: the number of unit squares
/// [loseille2011].
double complexity_of(const Mesh& mesh, const std::vector<Tensor2>& metric);

/// Returns the domain of a planar mesh (own method). Its names are indices into lists of the mesh: curves
/// (one more: sides without line), regions and named points. A curve ends where the outline turns by more
/// than kCornerTurn (degrees), at ends of straight sides, and where others meet. Throws InputError if the
/// mesh is not planar, or two of its points coincide.
PlanarModel trace_mesh(const Mesh& mesh);
inline constexpr double kCornerTurn = 40;

}  // namespace delquad
