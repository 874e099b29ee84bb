// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "delquad/hexahedra.h"
#include "metrics/cells.h"
#include "tests/features/extrusion/hex_checks.h"

namespace delquad::testing_support {

/// The faces between unit cubes of different labels, n of them along each axis; 0 lies outside. Quads look
/// away from the higher label, and each pair of labels is a region.
template <class Label>
Mesh skin_of_labels(int n, const Label& label_at) {
  Mesh mesh;
  std::map<std::array<int, 3>, int> place;
  std::map<std::array<int, 2>, int> region;
  const auto label = [&](std::array<int, 3> c) {
    return std::ranges::all_of(c, [&](int x) { return x >= 0 && x < n; }) ? label_at(c[0], c[1], c[2]) : 0;
  };
  const auto point = [&](const std::array<int, 3>& c) {
    const auto [at, is_new] = place.try_emplace(c, static_cast<int>(mesh.points.size()));
    if (is_new) mesh.points.push_back({double(c[0]), double(c[1]), double(c[2])});
    return at->second;
  };
  for (int k = 0; k < n * n * (n + 1) * 3; ++k) {
    const int axis = k % 3, u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::array<int, 3> cell = {};
    cell[axis] = k / 3 % (n + 1), cell[u] = k / 3 / (n + 1) % n, cell[v] = k / 3 / (n + 1) / n;
    std::array<int, 3> before = cell;
    --before[axis];
    const int high = label(cell), low = label(before);
    if (high == low) continue;
    std::array<int, 4> quad;
    for (int corner = 0; corner < 4; ++corner) {
      std::array<int, 3> at = cell;
      at[u] += corner == 1 || corner == 2, at[v] += corner >= 2;
      quad[corner] = point(at);
    }
    if (high > low) std::swap(quad[1], quad[3]);
    mesh.quads.push_back(quad);
    const auto [at, is_new] =
        region.try_emplace({std::min(low, high), std::max(low, high)}, static_cast<int>(mesh.regions.size()));
    if (is_new) {
      Entity entity{static_cast<int>(mesh.regions.size()) + 1, {}};
      for (const int of : {low, high})
        if (of > 0) entity.names.push_back("body " + std::to_string(of));
      mesh.regions.push_back(entity);
    }
    mesh.quad_region.push_back(at->second);
  }
  return mesh;
}

/// The mesh must be sound and have this volume.
inline void expect_sound_cells(const Mesh& mesh, double volume) {
  EXPECT_EQ(defects_of_cells(mesh), std::vector<std::string>());
  EXPECT_NEAR(measure(mesh).volume, volume, 1e-9 * volume);
}

}  // namespace delquad::testing_support
