// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "delquad/fields.h"
#include "geometry/mesh/nearest_triangle.h"
#include "geometry/surface/surface_model.h"

// This header has curvatures of models. Geometry and fields use it.

namespace delquad {

/// Curvature of the faces and curves of a model at any place. Make it from a model as it was read, since
/// points that later splits add lie in the plane of their triangles.
///
/// The curvature of a CAD face comes from its surface; elsewhere it is estimated from the triangles
/// [rusinkiewicz2004]. Normals at points are means over triangles, weighted by angle and smoothed against
/// noise. Their differences give the second fundamental form of each triangle; a point has the mean of the
/// forms around. The curvature of a curve is the curvature of the circle through neighboring points.
class ModelCurvature {
 public:
  explicit ModelCurvature(const SurfaceModel& model);

  /// Returns the largest curvature (1 / length) in any direction at the face's point nearest to x.
  double of_face(int face, const Vec3& x) const;
  /// Returns the principal curvatures (1 / length) there; 0 if unknown.
  PrincipalCurvatures principal(int face, const Vec3& x) const;
  /// Returns the curvature (1 / length) of a curve at its point nearest to x. The curve must exist since
  /// construction.
  double of_curve(int curve, const Vec3& x) const;

 private:
  /// Values at points, linear on triangles; lines count as triangles without area.
  struct Sampled {
    NearestTriangle triangles;
    std::vector<double> values;
    std::vector<Tensor3> forms = {};  ///< second fundamental forms of faces
    double at(const Vec3& x) const;
  };
  void estimate_faces(const Mesh& fine);
  void measure_curves(const Mesh& fine);

  std::shared_ptr<const SurfaceProjector> projector_;
  std::vector<std::optional<Sampled>> faces_;  ///< empty where the projector knows; none: a plane face
  std::vector<std::optional<Sampled>> curves_;
};

}  // namespace delquad
