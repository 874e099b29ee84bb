// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/surface/surface_model.h"

// This header makes one face of several. The input of surfaces uses it.

namespace delquad {

struct CompoundOptions {
  /// Degrees: where two curves meet after others are gone, they become one when they turn by less.
  double feature_angle = 40;
};

/// Returns the model with the faces of each group (indices into fine.regions) made one face. It has the least
/// tag of them and all their names. Curves with one group on both sides vanish. Where they ended, two curves
/// that are left over, with the same names and without a sharp turn, become one, which has the lesser tag.
/// Faces and curves keep their order otherwise. The projector goes to the former face whose fine triangles
/// are nearest, and to the nearest curve. Throws InputError for a face that does not exist or is in two
/// groups. So it does for a group whose faces do not hang together along curves.
SurfaceModel make_compound(SurfaceModel model, const std::vector<std::vector<int>>& groups,
                           const CompoundOptions& options = {});

/// Returns for each curve whether two faces join smoothly there. All along it, their normals differ by less
/// than `angle` (degrees). The normals are averages over the triangles at each line, or normals of the true
/// surfaces.
std::vector<char> tangent_curves(const SurfaceModel& model, double angle = 5);

/// Groups of two faces or more that join smoothly at some curve. With 180 all faces that hang together are a
/// group.
std::vector<std::vector<int>> tangent_groups(const SurfaceModel& model, double angle = 5);

/// Makes each curve shorter than `length` one with the curves that it continues. Only two curves meet there,
/// with the same names, and turn by less than the feature angle. Curves that are `kept` (by curve; empty:
/// none) stay as they are. The model's warnings name what became one.
SurfaceModel merge_short_curves(SurfaceModel model, double length, const CompoundOptions& options = {},
                                const std::vector<char>& kept = {});

}  // namespace delquad
