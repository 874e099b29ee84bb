// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "delquad/mesh.h"

// This header tells how patches of surfaces lie in space. Layers use it.

namespace delquad {

/// A point in the parameter plane of a patch and in space.
struct PatchPlace {
  Vec2 u;
  Vec3 x;
};

/// Maps between the parameter planes of patches and space. Planar domains need none.
class PatchPlaces {
 public:
  virtual ~PatchPlaces() = default;
  /// Returns the length in the plane over the length in space, at u along a unit vector.
  virtual double stretch(int patch, Vec2 u, Vec2 along) const = 0;
  /// Returns the place at a distance in space from another one, in a direction of the plane.
  virtual PatchPlace next(int patch, const PatchPlace& from, Vec2 along, double length) const = 0;
  /// Returns the place in the plane of a point near the patch, by the triangle at `near`.
  virtual Vec2 in_plane(int patch, const Vec3& x, Vec2 near) const = 0;
  /// Returns the place on a curve between two neighboring nodes, at a share `part` of the way. Cuts, which
  /// may be jagged, are straight in the plane of the patch, through `straight`.
  virtual Vec3 between(int a, int b, double part, int patch, Vec2 straight) const = 0;
  /// Returns whether a curve is a cut, with the same face on both sides.
  virtual bool is_cut(int curve) const = 0;
  /// Returns whether a curve of a patch lies on a plane of symmetry, behind which the image of the patch is.
  virtual bool is_axis(int patch, int curve) const = 0;
  /// Returns whether a curve begins or ends at a node.
  virtual bool is_end(int node) const = 0;
  /// Returns whether the nodes of the curve from a to b are given.
  virtual bool is_divided(int a, int b) const = 0;
};

}  // namespace delquad
