// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <TopTools_IndexedMapOfShape.hxx>
#include <array>
#include <vector>

#include "geometry/surface/surface_model.h"

// This header finds faces that touch and share no nodes. The reader of CAD warns of them.

namespace delquad::cad {

/// Two faces that share no nodes at the place where they are nearest to each other.
struct LooseJoint {
  std::array<int, 2> faces;  ///< indices of regions
  Vec3 at;                   ///< a place of the first
  double distance;           ///< from there to the second, a length
};

/// All are lengths.
struct JointOptions {
  double deflection;  ///< of the triangles
  double tolerance;   ///< faces touch up to this distance
  double reach;       ///< faces are near up to this distance
};

struct LooseJoints {
  std::vector<LooseJoint> touching;  ///< by their faces, with distance 0
  std::vector<LooseJoint> near;
};

/// Returns the joints between `faces` that no shell of a solid has both. A part is a set of faces that hang
/// together by edges. Two parts have one joint, where they touch or are nearest. In one open part each two
/// faces have one, if they touch or a free edge is near. A closed shell has no joints with itself, but for
/// faces that lie on each other up to their edges. `shells`: indices of the faces of each shell.
LooseJoints loose_joints(const SurfaceModel& model, const TopTools_IndexedMapOfShape& faces,
                         const std::vector<std::vector<int>>& shells, const JointOptions& options);

/// Returns the places where faces that do not hang together share a vertex, and for one of them it is no end
/// of a curve. It is a single point inside of that face, or the pole of a sphere. No node of a mesh joins
/// them there.
std::vector<LooseJoint> joints_at_points(const TopTools_IndexedMapOfShape& faces);

}  // namespace delquad::cad
