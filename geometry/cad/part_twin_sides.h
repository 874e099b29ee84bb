#pragma once

#include <array>
#include <vector>

#include "delquad/mesh.h"

namespace delquad::cad {

/// A point put inside a face, on the middle of a side.
struct PointInside {
  int point, face;  ///< indices, of points and regions
};

/// Two faces that share more than one curve, or nodes at its ends only, may both have a side between the same
/// two nodes, one or both of them inside: each is its own way over the surface. Such inner sides get a node
/// on their middle, so that an edge of the mesh tells the sides of its two triangles. `boundary`: the sides
/// (lower node first) that edges of each face have, sorted. Returns the new points.
std::vector<PointInside> part_twin_sides(Mesh& mesh,
                                         const std::vector<std::vector<std::array<int, 2>>>& boundary);

}  // namespace delquad::cad
