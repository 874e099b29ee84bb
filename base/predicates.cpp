// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/predicates.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace delquad::exact {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_2 point(Vec2 a) { return {a.x, a.y}; }

}  // namespace

int orient2d(Vec2 a, Vec2 b, Vec2 c) { return CGAL::orientation(point(a), point(b), point(c)); }

int in_circle(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  return CGAL::side_of_oriented_circle(point(a), point(b), point(c), point(d));
}

}  // namespace delquad::exact
