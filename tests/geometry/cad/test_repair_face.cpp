// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/weld_faces.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

using Triangles = std::vector<std::array<int, 3>>;

/// A square of corners 0 to 3 around its center 4.
const std::vector<Vec3> kPoints{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 0}};
const std::vector<std::array<int, 2>> kBoundary{{0, 1}, {1, 2}, {2, 3}, {3, 0}};
const Triangles kWhole{{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};

TEST(RepairFace, LeavesAWholeFaceAlone) {
  Triangles triangles = kWhole;
  EXPECT_EQ(cad::repair_face(kPoints, kBoundary, triangles), 0);
  EXPECT_EQ(triangles, kWhole);
}

TEST(RepairFace, FillsAGapAtTheBoundary) {
  Triangles triangles(kWhole.begin(), kWhole.begin() + 2);
  const double gap = cad::repair_face(kPoints, kBoundary, triangles);
  ASSERT_EQ(triangles.size(), 4u);
  double area = 0;
  for (const auto& [a, b, c] : triangles) {
    const double signed_area = cross(kPoints[b] - kPoints[a], kPoints[c] - kPoints[a]).z / 2;
    EXPECT_GE(signed_area, 0);
    area += signed_area;
  }
  EXPECT_DOUBLE_EQ(area, 1);
  EXPECT_NEAR(gap, 0.5 / (2 + std::sqrt(2.0)), 1e-12);
}

TEST(RepairFace, FillsTwoGapsThatTouch) {
  Triangles triangles{kWhole[0], kWhole[2]};
  cad::repair_face(kPoints, kBoundary, triangles);
  Triangles turned;
  for (auto t : triangles) {
    std::ranges::rotate(t, std::ranges::min_element(t));
    turned.push_back(t);
  }
  std::ranges::sort(turned);
  EXPECT_EQ(turned, (Triangles{{0, 1, 4}, {0, 4, 3}, {1, 2, 4}, {2, 3, 4}}));
}

TEST(RepairFace, TakesAwayWhatLiesOutside) {
  Triangles triangles = kWhole;
  triangles.push_back({1, 0, 4});
  triangles.push_back({0, 1, 4});
  triangles.push_back({0, 1, 4});
  cad::repair_face(kPoints, kBoundary, triangles);
  std::ranges::sort(triangles);
  EXPECT_EQ(triangles, kWhole);
}

TEST(RepairFace, RemovesFoldedPairsOnly) {
  // The pair on 0, 1, 5 ends in a point that nothing else uses.
  std::vector<Vec3> points = kPoints;
  points.push_back({0.5, 0.1, 0});
  Triangles triangles = kWhole;
  triangles.push_back({0, 1, 5});
  triangles.push_back({5, 1, 0});
  EXPECT_EQ(cad::repair_face(points, kBoundary, triangles), 0);
  EXPECT_EQ(triangles, kWhole);
}

TEST(RepairFace, KnowsThatTheSidesOfASeamCancel) {
  // A tube of three strips, closed along the seam 0-3.
  const std::vector<Vec3> points{{1, 0, 0}, {-0.5, 0.9, 0}, {-0.5, -0.9, 0},
                                 {1, 0, 1}, {-0.5, 0.9, 1}, {-0.5, -0.9, 1}};
  const std::vector<std::array<int, 2>> boundary{{0, 1}, {1, 2}, {2, 0}, {0, 3},
                                                 {3, 5}, {5, 4}, {4, 3}, {3, 0}};
  Triangles triangles{{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  const Triangles before = triangles;
  EXPECT_EQ(cad::repair_face(points, boundary, triangles), 0);
  EXPECT_EQ(triangles, before);
}

TEST(IsManifold, CountsTheTrianglesOfEachSide) {
  Triangles triangles = kWhole;
  EXPECT_TRUE(cad::is_manifold(triangles));
  triangles.push_back({4, 1, 5});
  EXPECT_FALSE(cad::is_manifold(triangles));
}

}  // namespace
}  // namespace delquad
