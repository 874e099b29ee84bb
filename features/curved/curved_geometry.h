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

/// The true model behind a mesh: where nodes of curved elements go. Safe to call from several threads.
class ModelGeometry {
 public:
  virtual ~ModelGeometry() = default;
  /// Returns the points of the curve of a line (index into Mesh::lines) at these parts of the way, by length
  /// along the curve. The way leads from the line's first end to its second. Parts are strictly between 0 and
  /// 1, ascending.
  virtual std::vector<Vec3> on_line(int line, std::span<const double> parts) const = 0;
  /// Returns the point of a curve (index into Mesh::curves) nearest to x; none: its lines are straight.
  virtual std::optional<Vec3> on_curve(int curve, const Vec3& x) const = 0;
  /// Returns whether a vertex of the straight mesh is one inside of a curve along which it may be moved.
  virtual bool slides(int vertex) const = 0;
  /// Returns the point of a face (index into Mesh::regions) nearest to x.
  virtual Vec3 on_face(int region, const Vec3& x) const = 0;
};

/// Returns the true model behind a mesh that was made of a problem: curves and formulas, CAD or triangles.
/// `nodes`: where the nodes on curves came to lie. Given lines, and lines of the mesh that are on no curve,
/// are straight. All arguments outlive it.
std::unique_ptr<ModelGeometry> true_geometry(const MeshingSetup& prepared, const SurfaceNodes& nodes,
                                             const Mesh& mesh);

/// A corner of a quad between two sides that both lie on lines.
struct CurveCorner {
  int quad, corner;  ///< index into Mesh::quads, 0 to 3
  int out, in;       ///< the lines (indices into Mesh::lines) of the sides after it and before it
  double angle;      ///< inside the quad, between the true curves' tangents: radians, in [-pi / 2, 3 pi / 2)
};

/// Returns all corners, in the quads' order, of a mesh of straight quads. An element that follows both curves
/// has no more than the angle's sine as its scaled Jacobian there.
std::vector<CurveCorner> curve_corners(const Mesh& straight, const ModelGeometry& geometry);

}  // namespace delquad
