#pragma once

#include <string>

#include "mesh/mesh.h"

namespace delquad {

struct MirrorPlane {
  Vec3 point, normal;  ///< the normal need not have unit length
  double tolerance =
      0;  ///< how far open edges may lie from the plane; a part of the model's diagonal, from 0
  /// Both images of a triangle are in its region, so that faces run on through the plane; else the other half
  /// has regions of its own, of the same names, and curves run along the plane.
  bool join = true;
};

/// Half a model of triangles, completed with its mirror image, which runs the other way round so that both
/// agree in orientation. Ends of open edges within the tolerance are moved onto the plane and belong to both
/// halves; lines there go. Both images of a line are on its curve. Throws InputError, beginning with
/// `source`, when points lie on both sides of the plane beyond the tolerance, when no open edge lies in the
/// plane and when a triangle does.
Mesh add_mirror_image(Mesh half, const MirrorPlane& plane, const std::string& source);

}  // namespace delquad
