// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "delquad/mesh.h"

// This header has the exact orientation of points in space. Tests of crossing triangles use it.

namespace delquad {

/// Returns the sign of the exact volume of the tetrahedron a, b, c, d, by CGAL. It is +1 if a, b, c run
/// counterclockwise seen from d, 0 if coplanar, else -1.
int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace delquad
