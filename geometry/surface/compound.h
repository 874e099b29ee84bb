// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "geometry/surface/surface_model.h"

// This header makes one face of several. The input of surfaces uses it.

namespace delquad {

struct CompoundOptions {
  /// Degrees, 0 to 180: two curves that meet after others vanished become one if they turn by less.
  double feature_angle = 40;
};

/// Returns the model with one face for each group (indices into fine.regions), with their least tag and all
/// their names. Curves with one group on both sides vanish. Where they ended, two remaining curves with the
/// same names and no sharp turn become one, with the lesser tag. Faces and curves keep their order otherwise.
/// The projector goes to the former face whose fine triangles are nearest, and to the nearest curve. Throws
/// InputError for a face that does not exist or is in two groups, and for a group whose faces no curves
/// connect.
SurfaceModel make_compound(SurfaceModel model, const std::vector<std::vector<int>>& groups,
                           const CompoundOptions& options = {});

/// Returns for each curve whether two faces join smoothly there: their normals differ by less than `angle`
/// (degrees) all along. The normals are averages over the triangles at each line, or normals of the true
/// surfaces.
std::vector<char> tangent_curves(const SurfaceModel& model, double angle = 5);

/// Returns the groups of two faces or more that curves with smooth joints connect. An angle of 180 degrees
/// groups all connected faces.
std::vector<std::vector<int>> tangent_groups(const SurfaceModel& model, double angle = 5);

/// Returns the model with each curve shorter than `length` joined to the curves that it continues. Only two
/// curves meet there, with the same names, and turn by less than the feature angle. Curves that are `kept`
/// (by curve; empty: none) stay. Warnings of the model name the joined curves.
SurfaceModel merge_short_curves(SurfaceModel model, double length, const CompoundOptions& options = {},
                                const std::vector<char>& kept = {});

/// Returns the largest distance, a length, of a corner at this place from the line without it.
using CurveTolerance = std::function<double(const Vec3&)>;

/// Returns the model with chains of curves joined to one, if all their points lie within their tolerance of
/// the line between its ends. Otherwise the farthest corner stays, and both parts of a chain are simplified
/// [douglas1973]. The surface and its lines stay; only corners go. Chains end at named points, where other
/// than two curves meet, where names change, and at curves that are `kept` (by curve; empty: none). Warnings
/// of the model name the joined curves.
SurfaceModel simplify_curves(SurfaceModel model, const CurveTolerance& tolerance,
                             const std::vector<char>& kept = {});

}  // namespace delquad
