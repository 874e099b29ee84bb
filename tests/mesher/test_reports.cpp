// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/outline.h"
#include "geometry/planar/check_lines.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

void add_ring(Mesh& mesh, const std::vector<Vec2>& corners, const std::string& name) {
  const int first = static_cast<int>(mesh.points.size()), n = static_cast<int>(corners.size());
  const int curve = static_cast<int>(mesh.curves.size());
  mesh.curves.push_back({curve + 1, name.empty() ? std::vector<std::string>{} : std::vector{name}});
  for (int i = 0; i < n; ++i) {
    mesh.points.push_back({corners[i].x, corners[i].y, 0});
    mesh.lines.push_back({first + i, first + (i + 1) % n});
    mesh.line_curve.push_back(curve);
  }
}

TEST(OddBoundaries, NameTheOddLoops) {
  Mesh lines;
  add_ring(lines, {{0, 0}, {4, 0}, {4, 4}, {0, 4}}, "outer");
  add_ring(lines, {{1, 1}, {2, 1}, {1, 2}}, "");
  const auto report = odd_boundaries(make_domain(lines));
  ASSERT_EQ(report.size(), 1u);
  EXPECT_TRUE(holds(report[0], "(7)", "curve 2", "3 edges"));
  EXPECT_EQ(report[0].find("'outer'"), std::string::npos) << report[0];
}

TEST(OddBoundaries, TwoOddLoopsOfOneRegionAreEven) {
  Mesh lines;
  add_ring(lines, {{0, 0}, {4, 0}, {4, 4}, {2, 5}, {0, 4}}, "outer");
  add_ring(lines, {{1, 1}, {2, 1}, {1, 2}}, "hole");
  EXPECT_TRUE(odd_boundaries(make_domain(lines)).empty());
}

TEST(Outline, OfElementsIsWhatOneElementHas) {
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}};
  mesh.quads = {{0, 1, 2, 3}};
  mesh.triangles = {{1, 4, 2}};
  const Mesh lines = outline(mesh);
  EXPECT_EQ(lines.lines.size(), 5u);
  for (const auto& line : lines.lines) EXPECT_FALSE(line[0] + line[1] == 3 && line[0] * line[1] == 2);
  EXPECT_EQ(make_domain(lines).patches.size(), 1u);
}

}  // namespace
}  // namespace delquad
