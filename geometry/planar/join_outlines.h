// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "delquad/model.h"

// This header joins curves to loops. Readers of outlines and model files use it.

namespace delquad {

/// Part of a model's diagonal: ends of curves that are nearer are one, and outlines that are nearer lie on
/// each other.
inline constexpr double kCoincidence = 1e-5;

/// Makes loops of curves that no loop has, except cracks. Ends within kCoincidence become one. Curves that
/// hang together are a loop if an even number of them meets at each end. Else their outer outline is the
/// loop, and the others stand in it. Curves with a loose end stand in the regions, too. Copies of curves are
/// dropped. Returns where a loose end is and how far the next one is, for messages; empty: no end is loose.
std::string join_outlines(PlanarModel& model);

/// Drops curves that no loop has, and points, outside of all loops. Returns how many.
int leave_out_outside(PlanarModel& model);

}  // namespace delquad
