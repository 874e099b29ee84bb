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

/// How strongly the faces and curves of a model are curved, wherever one asks. Make it from a model as it was
/// read: sides that are split later lie in the plane of their triangles and would hide it.
///
/// The curvature of a CAD face comes from its surface; elsewhere it is estimated from the triangles
/// [rusinkiewicz2004]. Normals at points are the mean of the triangles around by their angles, smoothed
/// against noise. Their differences give the second fundamental form of each triangle, and the mean of the
/// forms around a point counts there. The curvature of a curve is the curvature of the circle through
/// neighboring points.
class ModelCurvature {
 public:
  explicit ModelCurvature(const SurfaceModel& model);

  /// Returns the largest curvature (1 / length) in any direction at the face's point nearest to x.
  double of_face(int face, const Vec3& x) const;
  /// Returns the curvatures in all directions; 0 where it is not known.
  PrincipalCurvatures principal(int face, const Vec3& x) const;
  /// Returns the same of a curve that the model had when this was made.
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
