#include "io/hex_sides.h"

#include <algorithm>
#include <cstddef>

namespace delquad {

std::vector<HexSide> sorted_hex_sides(const Mesh& mesh) {
  constexpr int kSides[6][4] = {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1},
                                {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};
  std::vector<HexSide> sides;
  sides.reserve(6 * mesh.hexahedra.size());
  for (std::size_t h = 0; h < mesh.hexahedra.size(); ++h)
    for (int s = 0; s < 6; ++s) {
      HexSide side{{}, static_cast<int>(h), s + 1};
      for (int k = 0; k < 4; ++k) side.nodes[k] = mesh.hexahedra[h][kSides[s][k]];
      std::ranges::sort(side.nodes);
      sides.push_back(side);
    }
  std::ranges::stable_sort(sides, [](const HexSide& a, const HexSide& b) { return a.nodes < b.nodes; });
  return sides;
}

std::vector<HexSide> sides_at_quad(const Mesh& mesh, const std::vector<HexSide>& sorted, int quad) {
  std::array<int, 4> nodes = mesh.quads[quad];
  std::ranges::sort(nodes);
  const auto at = std::ranges::equal_range(sorted, nodes, {}, &HexSide::nodes);
  return {at.begin(), at.end()};
}

}  // namespace delquad
