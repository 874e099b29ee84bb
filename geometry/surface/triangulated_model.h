// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "geometry/surface/surface_model.h"

// This header makes surface models from triangles. The pipeline, features, readers and writers and geometry
// use it.

namespace delquad {

/// A ball in which sharp edges stay features, with its radius, a length.
struct FeatureBall {
  Vec3 at;
  double reach = 0;
};

struct TriangulatedOptions {
  /// Degrees, above 0 to 180. Neighboring triangles whose normals differ by more lie in different faces, and
  /// a curve that turns by more has a corner there.
  double feature_angle = 40;
  /// Distance >= 0, over the bounding box's diagonal, within which ends of open edges become one point.
  double weld_tolerance = 1e-9;
  /// File of the triangles, for messages.
  std::string source = "triangles";
  std::vector<FeatureBall> kept_features = {};
};

/// Returns a model of a triangulated surface, repaired (see repair_triangles()). The method is own.
///
/// The faces are the parts of the surface when it is cut at its outline, between regions, along the given
/// lines and along features. A face keeps the tag of its region; further faces of the same region get new
/// tags and its names. Curves are chains of these cuts. They end where other than two meet, where they turn
/// sharply, and where the given curve changes. A cut that ends inside a face is dropped from its loose end;
/// given lines move to SurfaceModel::loose. A cut with the same face on both sides but no loose end stays,
/// like the seam of a tube. In the balls of options.kept_features all edges of more than 60 degrees stay.
///
/// A triangle whose height is within the rounding of single precision takes the normal of its neighbor across
/// its longest side. So such slivers make no features.
///
/// Throws InputError as repair_triangles(), and std::invalid_argument for options out of range.
SurfaceModel make_surface_model(Mesh triangles, const TriangulatedOptions& options = {});

/// A model whose triangulation is a given mesh, point by point.
struct KeptModel {
  SurfaceModel model;
  /// Curve or region of the mesh for each curve or region of the model; -1: none.
  std::vector<int> given_curve, given_region;
};

/// Returns the model of a mesh that needs no repair except settle_triangles(), and keeps its points and
/// triangles. Triangles with the same `element` stay in one face. Given lines that end inside faces become
/// embedded curves, and so do two sides at a named point on no line. Throws as make_surface_model().
KeptModel make_kept_model(Mesh triangles, const std::vector<int>& element,
                          const TriangulatedOptions& options = {});

}  // namespace delquad
