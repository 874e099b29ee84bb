// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/volume/fill_steps.h"

#include "delquad/hexahedra.h"
#include "geometry/mesh/find_crossings.h"
#include "tests/features/extrusion/hex_checks.h"

namespace delquad {
namespace {

using namespace testing_support;
using Map = std::function<Vec3(const Vec3&)>;

/// Returns the surface of [-1, 1]^3 as n x n quads on each side, mapped, seen from outside.
Mesh skin_of_cube(std::array<int, 3> n, const Map& map) {
  Mesh skin;
  std::map<std::array<int, 3>, int> index;
  const auto vertex = [&](const std::array<int, 3>& c) {
    const auto [at, is_new] = index.try_emplace(c, static_cast<int>(skin.points.size()));
    if (is_new)
      skin.points.push_back(map({2.0 * c[0] / n[0] - 1, 2.0 * c[1] / n[1] - 1, 2.0 * c[2] / n[2] - 1}));
    return at->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const int end : {0, n[axis]})
      for (int i = 0; i < n[(axis + 1) % 3]; ++i)
        for (int j = 0; j < n[(axis + 2) % 3]; ++j) {
          std::array<int, 4> quad;
          for (int k = 0; k < 4; ++k) {
            std::array<int, 3> c;
            c[axis] = end;
            c[(axis + 1) % 3] = i + (k == 1 || k == 2);
            c[(axis + 2) % 3] = j + (k >= 2);
            quad[k] = vertex(c);
          }
          if (end == 0) std::swap(quad[1], quad[3]);
          skin.quads.push_back(quad);
          skin.quad_region.push_back(0);
        }
  skin.regions.push_back({1, {}});
  return skin;
}

Vec3 to_ball(const Vec3& x) {
  const double xx = x.x * x.x, yy = x.y * x.y, zz = x.z * x.z;
  return {x.x * std::sqrt(1 - yy / 2 - zz / 2 + yy * zz / 3),
          x.y * std::sqrt(1 - zz / 2 - xx / 2 + zz * xx / 3),
          x.z * std::sqrt(1 - xx / 2 - yy / 2 + xx * yy / 3)};
}

Vec3 to_cylinder(const Vec3& x) {
  return {x.x * std::sqrt(1 - x.y * x.y / 2), x.y * std::sqrt(1 - x.x * x.x / 2), x.z};
}

/// Returns six times the volume under a bilinear quad, seen from the origin, halved.
double under(const std::vector<Vec3>& p, const std::array<int, 4>& q) {
  const auto det = [&](int a, int b, int c) { return dot(p[q[a]], cross(p[q[b]], p[q[c]])); };
  return (det(0, 1, 2) + det(0, 2, 3) + det(0, 1, 3) + det(1, 2, 3)) / 12;
}

/// Expects positive hexahedra that meet in whole sides, and a closed boundary of the rest that does not cross
/// itself. Together these exclude overlaps. Returns the part of the volume that they fill.
double expect_placed(const Mesh& skin, const Mesh& mesh) {
  EXPECT_TRUE(std::equal(skin.points.begin(), skin.points.end(), mesh.points.begin()));
  EXPECT_EQ(skin.quads, mesh.quads);
  EXPECT_EQ(mesh.hexahedra.size(), mesh.hex_volume.size());
  std::map<std::array<int, 4>, std::vector<std::array<int, 4>>> sides;
  const auto add = [&](std::array<int, 4> side) {
    auto key = side;
    std::ranges::sort(key);
    sides[key].push_back(turned(side));
  };
  double whole = 0, filled = 0;
  for (auto q : mesh.quads) {
    whole += under(mesh.points, q);
    std::swap(q[1], q[3]);
    add(q);
  }
  for (const auto& hex : mesh.hexahedra) {
    for (const auto& side : sides_of(hex)) add(side), filled += under(mesh.points, side);
  }
  std::vector<std::array<int, 3>> triangles;
  for (const auto& [key, uses] : sides) {
    EXPECT_LE(uses.size(), 2U);
    auto back = uses[0];
    std::swap(back[1], back[3]);
    if (uses.size() == 2) {
      EXPECT_EQ(turned(back), uses[1]);
    } else {
      const auto& q = uses[0];
      for (int k = 0; k < 4; ++k) triangles.push_back({q[k], q[(k + 1) % 4], q[(k + 2) % 4]});
    }
  }
  EXPECT_FALSE(find_crossing(mesh.points, triangles, [](int a, int b) { return a / 4 == b / 4; }));
  EXPECT_FALSE(mesh.hexahedra.empty());
  EXPECT_GT(measure(mesh).least_jacobian, 0);
  return filled / whole;
}

double share(const Mesh& skin, const char* strategy = "DBC") {
  Mesh mesh = skin;
  place_hexahedra(mesh, strategy);
  return expect_placed(skin, mesh);
}

TEST(PlaceHexahedra, FillsBlocks) {
  const auto turn = [](const Vec3& x) { return Vec3{0.8 * x.x - 0.6 * x.y + 5, 0.6 * x.x + 0.8 * x.y, x.z}; };
  EXPECT_NEAR(share(skin_of_cube({6, 6, 6}, turn)), 1, 1e-12);
  EXPECT_NEAR(share(skin_of_cube({16, 12, 2},
                                 [](const Vec3& x) {
                                   return Vec3{8 * x.x, 6 * x.y, x.z};
                                 })),
              1, 1e-12);
  EXPECT_NEAR(share(skin_of_cube({8, 6, 3},
                                 [](const Vec3& x) {
                                   return Vec3{8 * x.x, 6 * x.y, 2.4 * x.z};
                                 })),
              1, 1e-12);
}

TEST(PlaceHexahedra, FillsMostOfRoundBodies) {
  EXPECT_GT(share(skin_of_cube({10, 10, 10}, to_ball)), 0.8);
  EXPECT_GT(share(skin_of_cube({8, 8, 8}, to_cylinder)), 0.8);
}

TEST(PlaceHexahedra, GoesAroundCavities) {
  Mesh skin = skin_of_cube({12, 12, 12}, [](const Vec3& x) { return x; });
  const Mesh cavity = skin_of_cube({8, 8, 8}, [](const Vec3& x) { return 0.5 * to_ball(x); });
  const int first = static_cast<int>(skin.points.size());
  skin.points.insert(skin.points.end(), cavity.points.begin(), cavity.points.end());
  for (const auto& [a, b, c, d] : cavity.quads) {
    skin.quads.push_back({a + first, d + first, c + first, b + first});
    skin.quad_region.push_back(0);
  }
  EXPECT_GT(share(skin), 0.6);
}

TEST(PlaceHexahedra, GoesOnBesideEdgesWithoutLength) {
  Mesh skin = skin_of_cube({6, 6, 6}, [](const Vec3& x) { return x; });
  const auto& quad = skin.quads[14];
  skin.points[quad[0]] = skin.points[quad[1]];
  EXPECT_GT(share(skin), 0.8);
}

TEST(PlaceHexahedra, ComparesStrategies) {
  const Mesh ball = skin_of_cube({10, 10, 10}, to_ball);
  const double cubes = share(ball), raw = share(ball, "DB"), tetrahedra = share(ball, "FBC");
  EXPECT_GT(cubes, raw);
  EXPECT_GT(raw, tetrahedra);
  EXPECT_GT(tetrahedra, 0.02);
}

TEST(PlaceHexahedra, GivesTheSameTwice) {
  Mesh first = skin_of_cube({6, 6, 6}, to_ball), second = first;
  place_hexahedra(first, "DBC");
  place_hexahedra(second, "DBC");
  EXPECT_EQ(first.points, second.points);
  EXPECT_EQ(first.hexahedra, second.hexahedra);
}

}  // namespace
}  // namespace delquad
