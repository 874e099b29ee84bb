// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include "geometry/surface/surface_editor.h"

// This header follows a plane over a triangulation. Imprinted lines use it.

namespace delquad {

/// A place where a plane meets a triangulation: a vertex (second < 0), or the inside of the edge between two
/// vertices.
using SectionPlace = std::pair<int, int>;

/// The plane through two vertices, along a normal.
struct SectionPlane {
  Vec3 at, normal;  ///< unit length
  double height(const Vec3& x) const { return dot(x - at, normal); }
};
/// Returns the plane through vertices a and b that contains `normal`.
SectionPlane section_plane(const Mesh& mesh, int a, int b, const Vec3& normal);

/// Returns the place in space.
Vec3 position(const Mesh& mesh, const SectionPlane& plane, const SectionPlace& place);

/// Longest way of a section, in distances of its ends.
inline constexpr double kMostDetour = 8;
/// Returns the shortest way from a to b in the section of the triangulation with a plane. Two places in a row
/// share a triangle. The way goes through vertices within `snap`, a length, of the plane. Empty if no way is
/// shorter than kMostDetour times the distance. Own method.
std::vector<SectionPlace> section_path(const Mesh& mesh, const SurfaceEditor& editor,
                                       const SectionPlane& plane, int a, int b, double snap);

}  // namespace delquad
