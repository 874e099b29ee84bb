#include "fields/sides.h"

namespace delquad {

Sides number_sides(const TriPatch& tri) {
  Sides sides{std::vector<std::array<int, 3>>(tri.triangles.size()), 0};
  for (int t = 0; t < static_cast<int>(tri.triangles.size()); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int other = tri.neighbours[t][k];
      if (other < 0 || other > t) {
        sides.of_triangle[t][k] = sides.count++;
        continue;
      }
      const auto& back = tri.neighbours[other];
      const int j = back[0] == t ? 0 : back[1] == t ? 1 : 2;
      sides.of_triangle[t][k] = sides.of_triangle[other][j];
    }
  }
  return sides;
}

}  // namespace delquad
