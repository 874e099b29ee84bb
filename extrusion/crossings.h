#pragma once

#include <array>
#include <optional>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

struct Crossing {
  int first, second;  ///< triangles
  Vec3 at;
};

/// The first of the triangles that an edge of another one goes through, both ends of which lie beside its
/// plane, decided exactly. Triangles may touch, and lie on each other.
std::optional<Crossing> find_crossing(const std::vector<Vec3>& points,
                                      const std::vector<std::array<int, 3>>& triangles);

}  // namespace delquad
