// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "delquad/error.h"
#include "delquad/model.h"

// This header joins polylines that nearly touch. The preparation uses it.

namespace delquad {

/// Corners and ends of a curve that is straight between them; nothing of others.
std::optional<std::vector<Vec2>> polyline_of(const Curve& curve);

/// Joins polylines of data, or `all` polylines, that overlap or gape by less than `tolerance`. Points that
/// are nearer become one, and segments pass through points that are nearer to them. So outlines that nearly
/// lie on each other have the same points. A warning tells how many points moved, and how far.
PlanarModel snap_outlines(PlanarModel model, double tolerance, bool all, std::vector<Warning>& warnings);

}  // namespace delquad
