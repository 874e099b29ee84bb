#include "geometry/planar/nest_loops.h"

#include <array>

#include "geometry/planar/arrangement.h"

namespace delquad {

LoopNesting nest_loops(const std::vector<Vec2>& points, const std::vector<std::vector<int>>& loops) {
  std::vector<std::array<int, 2>> lines;
  std::vector<std::array<int, 2>> place;  // of each line: loop, and which of its lines
  for (std::size_t l = 0; l < loops.size(); ++l) {
    for (std::size_t k = 0; k < loops[l].size(); ++k) {
      lines.push_back({loops[l][k], loops[l][(k + 1) % loops[l].size()]});
      place.push_back({static_cast<int>(l), static_cast<int>(k)});
    }
  }
  const Arrangement arrangement = arrange(points, lines);
  LoopNesting nesting;
  nesting.parent.assign(loops.size(), -1);
  if (arrangement.conflict) {
    const auto [a, b] = *arrangement.conflict;
    nesting.conflict = LineConflict{{place[a][0], place[b][0]}, {place[a][1], place[b][1]}};
    return nesting;
  }
  // Each loop is the outline of one face.
  for (const Arrangement::Face& face : arrangement.faces)
    if (face.around >= 0)
      nesting.parent[place[face.cycles[0][0] / 2][0]] =
          place[arrangement.faces[face.around].cycles[0][0] / 2][0];
  return nesting;
}

}  // namespace delquad
