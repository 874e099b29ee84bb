// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <string>

#include "delquad/error.h"
#include "delquad/fields.h"

// This header samples cross and size at vertices. Insertion uses it.

namespace delquad {

/// Fields at a vertex in the parameter plane, sampled once. The hints tell its place in the background meshes
/// of the fields.
struct VertexFields {
  Cross cross;  ///< of unit length; (1, 0) if the field vanishes
  double delta = 0;
  int cross_hint = -1, size_hint = -1;
};

/// Returns the fields at u, searched from a nearby point. Throws InputError unless the size is positive,
/// since insertion would not end.
inline VertexFields sample_fields(const CrossField& cross, const ParametricSize& size, Vec2 u,
                                  const VertexFields& near) {
  VertexFields f = near;
  const Cross z = cross.at(u, f.cross_hint);
  const double length = std::sqrt(z.c * z.c + z.s * z.s);
  f.cross = length > 0 ? Cross{z.c / length, z.s / length} : Cross{};
  f.delta = size.at(u, f.size_hint);
  if (!(f.delta > 0))
    throw InputError("the size in the parameter plane is " + std::to_string(f.delta) + " at (" +
                     std::to_string(u.x) + ", " + std::to_string(u.y) + "): expected a positive number");
  return f;
}

}  // namespace delquad
