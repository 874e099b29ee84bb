// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "delquad/model.h"

// This header joins curves to loops. Readers of outlines and model files use it.

namespace delquad {

/// Distance, over a model's diagonal, within which ends of curves coincide, and so do outlines.
inline constexpr double kCoincidence = 1e-5;

/// Makes loops of curves that no loop has, except cracks (own method). Ends within kCoincidence become one.
/// Connected curves are a loop if an even number of them meets at each end. Otherwise their outer outline is
/// the loop, and the others are embedded in it. Curves with a loose end are embedded, too. Copies of curves
/// are dropped. Returns the place of a loose end and the distance to the next one, for messages; empty: no
/// end is loose.
std::string join_outlines(PlanarModel& model);

/// Drops embedded curves and points outside of all loops. Returns their number.
int leave_out_outside(PlanarModel& model);

}  // namespace delquad
