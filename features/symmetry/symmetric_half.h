#pragma once

#include <string>
#include <vector>

#include "features/symmetry/mirror_match.h"
#include "geometry/planar/planar_model.h"

namespace delquad {

/// What of a symmetric model lies on the positive side of its planes: a half, a quarter or an eighth.
struct SymmetricHalf {
  /// With the faces of the whole, some without triangles, and the pieces of its curves; sections at the
  /// planes are curves of their own. All of its places on planes lie on them to rounding.
  SurfaceModel model;
  std::vector<int> whole_curve;   ///< of each curve of the half; -1: a section
  std::vector<int> curve_planes;  ///< of each curve of the half, the bits of the planes that it lies on
  struct Place {
    Vec3 at;
    int planes;  ///< bits
  };
  std::vector<Place> touching;   ///< places on planes where the half meets its image, and on no such curve
  std::vector<int> face_planes;  ///< of each face, the bits of the planes that it lies in, its own image
};

/// Cuts a model at its planes and keeps what lies on their positive sides. `matches`: of each plane. Curves
/// that leave a plane and come back to it, shorter than some sizes, get a corner between: a mesh of two
/// images must not have both as the same edge. Throws InputError, beginning with `where`, where a face lies
/// in a plane in part, and where a corner or a named point has no image.
SymmetricHalf cut_symmetric(const SurfaceModel& whole, const SymmetryPlanes& planes,
                            const std::vector<MirrorMatch>& matches, const PointSize& size,
                            const std::string& where);

}  // namespace delquad
