// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"

namespace delquad {
namespace {

MeshProblem grids_on(Mesh surface, double size, MappedSpec mapped) {
  MeshProblem problem = problem_of(TriangleModel{std::move(surface)}, size);
  problem.mapped = std::move(mapped);
  return problem;
}

std::map<int, int> valences(const Mesh& mesh) {
  std::vector<int> quads(mesh.points.size(), 0);
  for (const auto& quad : mesh.quads)
    for (const int v : quad) ++quads[v];
  std::map<int, int> count;
  for (const int n : quads) ++count[n];
  return count;
}

TEST(MappedSurfaces, ABoxIsSixGrids) {
  for (const char* word : {"DB", "DBCO"})
    for (const MappedSpec& spec : {MappedSpec{{}, true}, MappedSpec{{"region_1", "region_4", "region_5"}}}) {
      const MeshResult r = mesh(grids_on(box(3, 1, 1.5, 2), 0.23, spec), word);
      EXPECT_TRUE(r.mesh.triangles.empty());
      if (!spec.automatic) continue;
      EXPECT_EQ(valences(r.mesh)[3], 8);
      EXPECT_EQ(valences(r.mesh).size(), 2u);  // all others have four
      EXPECT_EQ(r.mesh.quads.size(), 2u * (4 * 7 + 4 * 9 + 7 * 9));
      EXPECT_NEAR(r.metrics.values.at("eta_worst"), 1, 1e-9);
    }
}

TEST(MappedSurfaces, ATubeIsAGridThatClosesAround) {
  for (const MappedSpec& spec : {MappedSpec{{"region_1"}}, MappedSpec{{}, true}}) {
    // O moves what was not asked for.
    const MeshResult r = mesh(grids_on(can(48, 4), 0.15, spec), spec.automatic ? "DB" : "DBCO");
    EXPECT_TRUE(r.mesh.triangles.empty());
    // The wall: nodes at equal heights, as many at each.
    std::map<long, int> at_height;
    std::vector<char> on_wall(r.mesh.points.size(), 0);
    for (std::size_t q = 0; q < r.mesh.quads.size(); ++q)
      if (r.mesh.regions[r.mesh.quad_region[q]].tag == 1)
        for (const int v : r.mesh.quads[q]) on_wall[v] = 1;
    for (std::size_t v = 0; v < on_wall.size(); ++v)
      if (on_wall[v]) ++at_height[std::lround(r.mesh.points[v].z * 1e6)];
    EXPECT_GE(at_height.size(), 6u);
    for (const auto& [height, n] : at_height) EXPECT_EQ(n, at_height.begin()->second);
  }
}

/// A part of a cylinder about z, of this angle, as triangles.
Mesh cylinder_piece(int n, double angle, double height) {
  TriangulatedShape shape;
  shape.region();
  const auto at = [&](int i, int j) {
    const double t = angle * i / n;
    return Vec3{std::cos(t), std::sin(t), height * j / n};
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      shape.triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      shape.triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  return shape.mesh;
}

TEST(MappedSurfaces, APieceOfACylinderIsRegular) {
  const MeshResult r = mesh(grids_on(cylinder_piece(60, 2.2, 1.3), 0.13, {{"region_1"}}), "DBCO");
  EXPECT_EQ(valences(r.mesh)[1], 4);
  EXPECT_EQ(r.mesh.quads.size(), 17u * 10);
  for (const Vec3& x : r.mesh.points) {
    const double row = x.z / 0.13, column = std::atan2(x.y, x.x) / 2.2 * 17;
    EXPECT_NEAR(row, std::round(row), 1e-6);
    EXPECT_NEAR(column, std::round(column), 1e-2);  // the fine triangles are flat
  }
}

/// Its long sides, which agree, are two rows apart.
TEST(MappedSurfaces, NarrowFacesAreGrids) {
  for (const char* word : {"DB", "DBCO", "FB"})
    for (const double height : {0.6, 0.9, 1.4, 1.6, 2.0, 2.4}) {
      SCOPED_TRACE(testing::Message() << word << ' ' << height);
      const MeshResult r = mesh(grids_on(cylinder_piece(60, 2.2, 0.13 * height), 0.13, {}), word);
      EXPECT_EQ(r.mesh.quads.size(), 17u * std::lround(height));
      EXPECT_EQ(valences(r.mesh).size(), height > 1.5 ? 3u : 2u);
      EXPECT_EQ(valences(r.mesh)[3], 0);
    }
}

/// Flat, of radius 5 outside, as triangles.
Mesh flat_ring(double width) {
  TriangulatedShape shape;
  shape.region();
  constexpr int kAround = 120;
  const auto at = [&](int i, double r) {
    const double t = 2 * std::numbers::pi * (i % kAround) / kAround;
    return Vec3{r * std::cos(t), r * std::sin(t), 0};
  };
  for (int i = 0; i < kAround; ++i) {
    shape.triangle(at(i, 5 - width), at(i, 5), at(i + 1, 5));
    shape.triangle(at(i, 5 - width), at(i + 1, 5), at(i + 1, 5 - width));
  }
  return shape.mesh;
}

TEST(MappedSurfaces, NarrowRingsAreRows) {
  for (const char* word : {"DB", "DBCO"})
    for (const double width : {0.8, 1.2, 1.6, 2.4}) {
      SCOPED_TRACE(testing::Message() << word << ' ' << width);
      const MeshResult r = mesh(grids_on(flat_ring(width), 1, {}), word);
      const double around = 2 * std::numbers::pi * std::sqrt(5 * (5 - width));
      const double n = static_cast<double>(r.mesh.quads.size()) / std::lround(width);
      EXPECT_NEAR(n, around, 2);
      EXPECT_EQ(n, std::round(n));
      EXPECT_EQ(valences(r.mesh).size(), width > 1.5 ? 2u : 1u);
    }
}

TEST(MappedSurfaces, WhatCannotBeIsRefused) {
  const auto refused = [](Mesh surface, MappedSpec spec, std::initializer_list<const char*> says) {
    spec.where = "m 1";
    expect_refused(grids_on(std::move(surface), 0.2, spec), "DBCO", says);
  };
  refused(box(3), {{"region_9"}}, {"m 1: no region is called 'region_9'"});
  refused(can(24, 3), {{"region_2"}}, {"m 1: 'region_2' cannot be a grid: its outline has"});
  MeshProblem divided = grids_on(box(3), 0.2, {{"region_1"}, false, "m 1"});
  divided.divisions = {{"curve_1", 4, 1, 1, "d 1"},
                       {"curve_2", 5, 1, 1, "d 2"},
                       {"curve_3", 7, 1, 1, "d 3"},
                       {"curve_4", 8, 1, 1, "d 4"}};
  expect_refused(divided, "DBCO", {"m 1", "sides that do not match", "'curve_"});
}

}  // namespace
}  // namespace delquad
