// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/quad_corners.h"

namespace delquad {

std::array<double, 4> corner_sines(const QuadTopology& mesh, int element) {
  const int n = mesh.is_quad(element) ? 4 : 3;
  Vec2 side[4];
  for (int k = 0; k < n; ++k) {
    const int h = 4 * element + k;
    side[k] = mesh.point(mesh.target(h)) - mesh.point(mesh.origin(h));
    side[k] = (1 / std::max(norm(side[k]), kTinyLength)) * side[k];
  }
  std::array<double, 4> sines{cross(side[n - 1], side[0]), 1, 1, 1};
  for (int k = 1; k < n; ++k) sines[k] = cross(side[k - 1], side[k]);
  return sines;
}

double least_sine(const QuadTopology& mesh, int element) {
  const auto sines = corner_sines(mesh, element);
  return std::min({sines[0], sines[1], sines[2], sines[3]});
}

}  // namespace delquad
