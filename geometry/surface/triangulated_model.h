// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "geometry/surface/surface_model.h"

// This header makes surface models from triangles. The pipeline, features, readers and writers and geometry
// use it.

namespace delquad {

/// A ball in which sharp edges stay features, wherever they lead.
struct FeatureBall {
  Vec3 at;
  double reach = 0;
};

struct TriangulatedOptions {
  /// Degrees, above 0 to 180. Neighboring triangles whose normals differ by more lie in different faces, and
  /// a curve that turns by more has a corner there.
  double feature_angle = 40;
  /// Ends of open edges no further apart become one point; a part of the bounding box's diagonal, from 0.
  double weld_tolerance = 1e-9;
  /// The file that the triangles are from, for messages.
  std::string source = "triangles";
  std::vector<FeatureBall> kept_features = {};
};

/// Returns a model of a triangulated surface, repaired (see repair_triangles).
///
/// The faces are the parts of the surface when it is cut at its outline, between regions, along the given
/// lines and along features. A face keeps the tag of its region; further faces of the same region get new
/// tags and its names. Curves are the chains of these cuts, ended where other than two meet, where they turn
/// sharply and where the given curve changes. A cut that ends inside a face bounds nothing. It is dropped
/// from its loose end, given lines to SurfaceModel::loose. A cut that has the same face on both sides but no
/// loose end stays, like the seam of a tube. In the balls of options.kept_features all edges of more than 60
/// degrees stay.
///
/// The direction of a triangle. If its height is within the rounding of single precision, it is the direction
/// of its neighbor across its longest side. Such slivers make no features.
///
/// Throws InputError for what cannot be repaired; invalid_argument for a feature angle out of range.
SurfaceModel make_surface_model(Mesh triangles, const TriangulatedOptions& options = {});

/// A model whose triangulation is a mesh that was given, point by point.
struct KeptModel {
  SurfaceModel model;
  /// The curve or region of the mesh that each of the model's is a part of; -1: of none.
  std::vector<int> given_curve, given_region;
};

/// Returns the same for a mesh that needs no repair except settle_triangles(), and keeps its points and
/// triangles. Triangles with the same `element` stay in one face. Given lines that end inside faces become
/// embedded curves there, and so do two sides at a named point that is on no line.
KeptModel make_kept_model(Mesh triangles, const std::vector<int>& element,
                          const TriangulatedOptions& options = {});

}  // namespace delquad
