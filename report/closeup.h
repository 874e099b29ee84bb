#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// A bad quad and what is around it, seen from its front.
struct Closeup {
  double eta;
  double size;  ///< mean edge
  Vec3 normal;
  Vec3 at;                                 ///< its centre
  std::vector<Vec2> points;                ///< in units of the quad's mean edge, its centre at the origin
  std::vector<std::vector<int>> elements;  ///< triangles and quads, the bad quad first
  std::vector<double> etas;                ///< of the elements; those of triangles are 1
};

/// The `count` worst quads of which no two have a vertex in common, worst first, with the elements that three
/// steps from element to element lead to.
std::vector<Closeup> worst_quads(const Mesh& mesh, std::size_t count);

}  // namespace delquad
