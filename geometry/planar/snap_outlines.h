// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "delquad/error.h"
#include "delquad/model.h"

// This header joins polylines that nearly touch. The preparation uses it.

namespace delquad {

/// Returns the corners and ends of a curve that is straight between them; nothing for other curves.
std::optional<std::vector<Vec2>> polyline_of(const Curve& curve);

/// Returns the model with polylines of data, or `all` polylines, joined where they overlap or gape by less
/// than `tolerance`, a length (own method). Points that are nearer become one, and segments then pass through
/// points that are nearer to them. A warning tells how many points moved, and how far.
PlanarModel snap_outlines(PlanarModel model, double tolerance, bool all, std::vector<Warning>& warnings);

}  // namespace delquad
