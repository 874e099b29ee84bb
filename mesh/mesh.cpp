#include "mesh/mesh.h"

#include <algorithm>

namespace delquad {

double diagonal(const Mesh& mesh) {
  if (mesh.points.empty()) return 0;
  Vec3 low = mesh.points.front(), high = low;
  for (const Vec3& p : mesh.points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return norm(high - low);
}

}  // namespace delquad
