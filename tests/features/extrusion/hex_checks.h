// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "delquad/hexahedra.h"
#include "tests/support/meshing.h"

namespace delquad::testing_support {

inline constexpr double kPi = std::numbers::pi;

inline void expect_not_extruded(const Mesh& mesh, const SweepPath& path, const SweepLayers& layers,
                                std::initializer_list<const char*> parts) {
  expect_input_error([&] { extrude(mesh, path, layers); }, parts);
}

/// A hexahedron's sides, counterclockwise seen from outside.
inline std::array<std::array<int, 4>, 6> sides_of(const std::array<int, 8>& h) {
  return {{{h[0], h[3], h[2], h[1]},
           {h[4], h[5], h[6], h[7]},
           {h[0], h[1], h[5], h[4]},
           {h[1], h[2], h[6], h[5]},
           {h[2], h[3], h[7], h[6]},
           {h[3], h[0], h[4], h[7]}}};
}

/// Begins with its least number, so that turned ones are the same and reversed ones are not.
inline std::array<int, 4> turned(std::array<int, 4> quad) {
  std::rotate(quad.begin(), std::min_element(quad.begin(), quad.end()), quad.end());
  return quad;
}

/// Hexahedra are positive and conforming; their boundary is all there as quads, each once, that look
/// outwards.
inline void expect_sound(const Mesh& mesh) {
  ASSERT_EQ(mesh.hex_volume.size(), mesh.hexahedra.size());
  ASSERT_EQ(mesh.quad_region.size(), mesh.quads.size());
  ASSERT_EQ(mesh.line_curve.size(), mesh.lines.size());
  EXPECT_GT(measure(mesh).least_jacobian, 0);
  std::map<std::array<int, 4>, int> uses;
  std::set<std::array<int, 4>> outer;
  std::vector<char> used(mesh.points.size(), 0);
  for (const auto& h : mesh.hexahedra) {
    for (const int v : h) used[v] = 1;
    for (const auto& side : sides_of(h)) {
      std::array<int, 4> key = side;
      std::sort(key.begin(), key.end());
      ++uses[key];
      outer.insert(turned(side));
    }
  }
  EXPECT_EQ(std::ranges::count(used, 0), 0) << "points that nothing uses";
  std::size_t on_boundary = 0;
  for (const auto& [key, n] : uses) {
    EXPECT_LE(n, 2);
    on_boundary += n == 1;
  }
  std::size_t written = 0;
  for (const auto& quad : mesh.quads) {
    EXPECT_TRUE(outer.contains(turned(quad)));
    std::array<int, 4> key = quad;
    std::sort(key.begin(), key.end());
    written += uses[key] == 1;
  }
  EXPECT_EQ(written, on_boundary);
}

/// Numbers of quads by the names of their faces.
inline std::map<std::string, int> quads_by_name(const Mesh& mesh) {
  std::map<std::string, int> counts;
  for (const int face : mesh.quad_region)
    for (const std::string& name : mesh.regions[face].names) ++counts[name];
  return counts;
}

/// A structured patch: corner (i, j) of n x m cells lies at place(i / n, j / m); points that fall together
/// are one.
template <class Place>
void add_patch(Mesh& mesh, int n, int m, const Place& place, int region = 0) {
  std::vector<int> at;
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i <= n; ++i) {
      const Vec3 p = place(double(i) / n, double(j) / m);
      const auto same = std::ranges::find_if(mesh.points, [&](const Vec3& q) { return norm(p - q) < 1e-9; });
      at.push_back(static_cast<int>(same - mesh.points.begin()));
      if (same == mesh.points.end()) mesh.points.push_back(p);
    }
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i;
      mesh.quads.push_back({at[a], at[a + 1], at[a + n + 2], at[a + n + 1]});
      mesh.quad_region.push_back(region);
    }
  while (static_cast<int>(mesh.regions.size()) <= region)
    mesh.regions.push_back({static_cast<int>(mesh.regions.size()) + 1, {}});
}

/// The surface of [-1, 1]^3, n cells along each edge, quads outwards; `move` maps it.
template <class Move>
Mesh cube_surface(int n, const Move& move) {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0})
      add_patch(mesh, n, n, [&](double s, double t) {
        const double u = side * (2 * s - 1), v = 2 * t - 1;
        return move(axis == 0 ? Vec3{side, u, v} : axis == 1 ? Vec3{v, side, u} : Vec3{u, v, side});
      });
  return mesh;
}

inline Mesh sphere(int n, double radius) {
  return cube_surface(n, [&](const Vec3& p) {
    const Vec3 q{std::tan(kPi / 4 * p.x), std::tan(kPi / 4 * p.y), std::tan(kPi / 4 * p.z)};
    return radius / norm(q) * q;
  });
}

}  // namespace delquad::testing_support
