#pragma once

#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// A triangulation of the suite: points and triangles only, outward where it is closed. Coordinates are
/// rounded to nine digits after the point.
struct TriangleSuiteModel {
  const char* name;
  Mesh (*make)();
};
const std::vector<TriangleSuiteModel>& triangle_suite_models();

// The models by how their points are found, one file each.
Mesh make_sphere_noisy();
Mesh make_sphere_graded();
Mesh make_torus_noisy();
Mesh make_torus_holes();
Mesh make_knot();
Mesh make_washer();
Mesh make_star_prism();
Mesh make_genus3();
Mesh make_genus3_noisy();
Mesh make_blobs();
Mesh make_terrain();
Mesh make_terrain_holes();

}  // namespace delquad
