// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <random>
#include <utility>
#include <vector>

#include "delquad/mesh.h"

namespace delquad::testing_support {

/// Unstructured quads of [0, width] x [0, height]: triangles of a shaken grid of n x n cells, each cut into
/// three.
inline Mesh ugly_quads(int n, double width = 1, double height = 1) {
  std::mt19937_64 random(n);
  const auto shake = [&] { return 0.6 * (static_cast<double>(random() % 1000) / 1000 - 0.5); };
  Mesh mesh;
  mesh.regions = {{1, {}}};
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const double x = i + (i > 0 && i < n ? shake() : 0), y = j + (j > 0 && j < n ? shake() : 0);
      mesh.points.push_back({width * x / n, height * y / n, 0});
    }
  std::map<std::pair<int, int>, int> middle_of;
  const auto add = [&](const Vec3& x) {
    mesh.points.push_back(x);
    return static_cast<int>(mesh.points.size()) - 1;
  };
  const auto middle = [&](int a, int b) {
    const auto [at, is_new] = middle_of.try_emplace(std::minmax(a, b), 0);
    if (is_new) at->second = add(0.5 * (mesh.points[a] + mesh.points[b]));
    return at->second;
  };
  const auto cut = [&](int a, int b, int c) {
    const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    const int m = add((1.0 / 3) * (mesh.points[a] + mesh.points[b] + mesh.points[c]));
    mesh.quads.insert(mesh.quads.end(), {{a, ab, m, ca}, {ab, b, bc, m}, {ca, m, bc, c}});
  };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = c - 1;
      random() % 2 == 0 ? (cut(a, b, c), cut(a, c, d)) : (cut(a, b, d), cut(b, c, d));
    }
  mesh.quad_region.assign(mesh.quads.size(), 0);
  return mesh;
}

template <class F>
std::vector<double> values_of(const Mesh& mesh, F f) {
  std::vector<double> values;
  for (const Vec3& x : mesh.points) values.push_back(f(x.x, x.y));
  return values;
}

}  // namespace delquad::testing_support
