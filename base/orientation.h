#pragma once

#include "delquad/mesh.h"

namespace delquad {

/// Sign of the exact volume of the tetrahedron a, b, c, d: +1 where d lies on the side from which a, b, c run
/// counterclockwise, 0 in their plane, else -1.
int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace delquad
