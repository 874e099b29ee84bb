// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "delquad/mesh.h"
#include "geometry/patches/meshing_setup.h"

// This header has the true curves and faces behind a mesh. Features use it.

namespace delquad {

/// The true model behind a mesh, on which nodes of curved elements lie. Several threads may call it.
class ModelGeometry {
 public:
  virtual ~ModelGeometry() = default;
  /// Returns points on the curve of a line (index into Mesh::lines), from its first end to its second.
  /// `parts` are shares of the length along the curve, ascending, strictly between 0 and 1.
  virtual std::vector<Vec3> on_line(int line, std::span<const double> parts) const = 0;
  /// Returns the point of a curve (index into Mesh::curves) nearest to x; nothing if its lines are straight.
  virtual std::optional<Vec3> on_curve(int curve, const Vec3& x) const = 0;
  /// Returns whether a vertex of the straight mesh lies inside of a curve and may move along it.
  virtual bool slides(int vertex) const = 0;
  /// Returns the point of a face (index into Mesh::regions) nearest to x.
  virtual Vec3 on_face(int region, const Vec3& x) const = 0;
};

/// Returns the true model behind a mesh of a problem: curves and formulas, CAD or triangles. `nodes` has the
/// places of nodes on curves. Given lines, and lines of the mesh that are on no curve, are straight. All
/// arguments must outlive it.
std::unique_ptr<ModelGeometry> true_geometry(const MeshingSetup& prepared, const SurfaceNodes& nodes,
                                             const Mesh& mesh);

/// A corner of a quad between two sides that both lie on lines.
struct CurveCorner {
  int quad, corner;  ///< index into Mesh::quads, 0 to 3
  int out, in;       ///< indices into Mesh::lines of the sides after the corner and before it
  double angle;      ///< radians inside the quad, between tangents of the true curves, in [-pi / 2, 3 pi / 2)
};

/// Returns all such corners of a mesh of straight quads, in the order of the quads. There the scaled Jacobian
/// of an element that follows both curves is at most the sine of the angle.
std::vector<CurveCorner> curve_corners(const Mesh& straight, const ModelGeometry& geometry);

}  // namespace delquad
