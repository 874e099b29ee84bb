// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include "geometry/surface/surface_editor.h"

// This header follows a plane over a triangulation. Imprinted lines use it.

namespace delquad {

/// A place on a triangulation that a plane goes through: a vertex (second < 0) or the inside of the edge
/// between two.
using SectionPlace = std::pair<int, int>;

/// The plane through two vertices, along a normal.
struct SectionPlane {
  Vec3 at, normal;  ///< unit length
  double height(const Vec3& x) const { return dot(x - at, normal); }
};
SectionPlane section_plane(const Mesh& mesh, int a, int b, const Vec3& normal);

/// Returns the place in space.
Vec3 position(const Mesh& mesh, const SectionPlane& plane, const SectionPlace& place);

/// The shortest way from a to b in the section of the triangulation with a plane: places that share
/// triangles. Vertices within `snap` of the plane lie in it, so that the way leads through them. Empty where
/// there is none of at most kMostDetour times the distance.
inline constexpr double kMostDetour = 8;
std::vector<SectionPlace> section_path(const Mesh& mesh, const SurfaceEditor& editor,
                                       const SectionPlane& plane, int a, int b, double snap);

}  // namespace delquad
