#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

struct Crossing {
  int first, second;  ///< triangles
  Vec3 at;
};

/// The first of the triangles an edge of which goes through another one, both ends beside its plane, decided
/// exactly. Triangles may touch, and lie on each other; pairs that `may_cross` are left out.
std::optional<Crossing> find_crossing(
    const std::vector<Vec3>& points, const std::vector<std::array<int, 3>>& triangles,
    const std::function<bool(int, int)>& may_cross = [](int, int) { return false; });

}  // namespace delquad
