// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "base/warning.h"
#include "delquad/mesh.h"

// This header has surfaces as fine triangulations with their true geometry. Most modules use it.

namespace delquad {

/// Curvatures (1 / length) of a face at a point, along two perpendicular directions; NaN where not known.
struct PrincipalCurvatures {
  double most = std::numeric_limits<double>::quiet_NaN();  ///< the larger by size
  double least = 0;
  Vec3 along = {};  ///< the direction of `most`, of length 1
};

/// The true geometry behind a fine triangulation.
class SurfaceProjector {
 public:
  virtual ~SurfaceProjector() = default;
  /// Returns the point of a face (index into SurfaceModel::fine.regions) nearest to x; safe to call from
  /// several threads.
  virtual Vec3 to_face(int face, const Vec3& x) const = 0;
  /// Returns the point of a curve (index into SurfaceModel::fine.curves) nearest to x; safe to call from
  /// several threads.
  virtual Vec3 to_curve(int curve, const Vec3& x) const = 0;
  /// Returns the curvatures of a face at a point next to x; not known at singular points of the
  /// parametrization. Several threads may call it.
  virtual PrincipalCurvatures curvatures([[maybe_unused]] int face, [[maybe_unused]] const Vec3& x) const {
    return {};
  }
  /// Returns the largest absolute curvature in any direction; NaN if unknown.
  double face_curvature(int face, const Vec3& x) const { return std::abs(curvatures(face, x).most); }
};

/// A face that is missing from a model because it cannot be used.
struct LeftOutFace {
  int face;            ///< index into SurfaceModel::fine.regions, which has no triangles
  std::string reason;  ///< names the face
};

/// A polyline, or a single point, on a surface that is no part of its triangulation yet, see imprint().
struct LooseLine {
  std::vector<Vec3> points;        ///< one: a point
  std::vector<std::string> names;  ///< names of physical groups; may be empty
  std::string where;               ///< label for messages
  /// Whether the user requested it: then all its points become nodes, and it must lie on the surface.
  /// Otherwise it is from the model's file. Its ends and sharp turns become nodes, and it is left out with a
  /// warning if it is off the surface.
  bool is_requested = false;
  bool is_crack = false;  ///< see EmbeddedCurve::is_crack
};

/// A curve inside of a face, with the face on both sides, which need not reach the face's boundary.
struct EmbeddedCurve {
  int curve;                 ///< index into SurfaceModel::fine.curves
  int face;                  ///< index into SurfaceModel::fine.regions
  bool is_dangling = false;  ///< a short one, in any direction, at a single point
  bool is_crack = false;     ///< the mesh comes apart along it
};

/// A model made of faces that share curves, as a fine conforming triangulation.
struct SurfaceModel {
  std::string source;  ///< file it was read from, for messages
  /// Triangles tagged by face (triangle_region), lines tagged by curve (line_curve). Every line is a side of
  /// triangles, and every side between two faces, on the outline or on a feature is a line. The lines of a
  /// curve form one chain, open or closed, listed from end to end, all in one direction. Triangles agree in
  /// orientation wherever the model is orientable.
  Mesh fine;
  /// Points of `fine` that must be nodes of any mesh, ascending. They are ends of curves, points where more
  /// than two curves meet, and imprinted points. fine.named_points are among them.
  std::vector<int> corners;
  /// Null: the triangulation itself is the surface.
  std::shared_ptr<const SurfaceProjector> projector;
  std::vector<LooseLine> loose;          ///< lines that imprint() will add
  std::vector<EmbeddedCurve> embedded;   ///< by curve
  std::vector<std::array<int, 2>> lips;  ///< both curves of each crack that is open, see open_cracks()
  std::vector<LeftOutFace> left_out;
  std::shared_ptr<const Mesh> before;  ///< `fine` before ignore_small(); null if it did not run
  std::vector<Warning> warnings;       ///< repairs and suspicious parts
};

}  // namespace delquad
