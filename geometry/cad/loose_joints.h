// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <TopTools_IndexedMapOfShape.hxx>
#include <array>
#include <vector>

#include "geometry/surface/surface_model.h"

// This header finds faces that touch and share no nodes. The reader of CAD warns of them.

namespace delquad::cad {

/// Two faces that share no nodes, and the place where they are nearest to each other.
struct LooseJoint {
  std::array<int, 2> faces;  ///< indices of regions
  Vec3 at;                   ///< place on the first face
  double distance;           ///< distance from there to the second face, a length
};

/// Distances, all lengths.
struct JointOptions {
  double deflection;  ///< deflection of the triangles
  double tolerance;   ///< faces touch up to this distance
  double reach;       ///< faces are near up to this distance
};

struct LooseJoints {
  std::vector<LooseJoint> touching;  ///< joints that touch, by their faces, with distance 0
  std::vector<LooseJoint> near;
};

/// Returns the joints between two of the `faces` that are in no common shell (own method). A part is a set of
/// faces that edges connect. Two parts have one joint, where they touch or are nearest. In an open part each
/// two faces have one, if they touch or a free edge is near. A closed shell has joints with itself only if
/// faces lie on each other. `shells` has the indices of the faces of each shell.
LooseJoints loose_joints(const SurfaceModel& model, const TopTools_IndexedMapOfShape& faces,
                         const std::vector<std::vector<int>>& shells, const JointOptions& options);

/// Returns the places where faces of different parts share a vertex that is no end of a curve for one of
/// them. It is a single point inside of this face, or the pole of a sphere. No node of a mesh can join them
/// there.
std::vector<LooseJoint> joints_at_points(const TopTools_IndexedMapOfShape& faces);

}  // namespace delquad::cad
