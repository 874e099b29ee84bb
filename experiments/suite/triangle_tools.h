#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// Adds the two triangles of a quad, which is split at a - c.
void add_quad(Mesh& mesh, int a, int b, int c, int d);
/// Moves every point by up to `amount` (length) along each axis.
void shake(Mesh& mesh, double amount, std::uint64_t seed);
/// Takes away the triangles with a point in one of the balls, and the points that nothing uses.
struct Ball {
  Vec3 centre;
  double radius;
};
void cut_holes(Mesh& mesh, const std::vector<Ball>& balls);
/// Every triangle becomes four.
void subdivide(Mesh& mesh);
/// Rounds the coordinates to nine digits after the point.
Mesh rounded(Mesh mesh);

/// A grid of n1 x n2 quads that closes both ways, split into triangles.
Mesh closed_grid(int n1, int n2, const std::function<Vec3(double, double)>& at);

/// The surface f = 0 of a function that is negative inside, in cubes of edge `step` between two corners, each
/// cut into six tetrahedra: triangles of any shape, slivers too.
Mesh zero_surface(const std::function<double(const Vec3&)>& f, const Vec3& low, const Vec3& high,
                  double step);

}  // namespace delquad
