// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/check_mesh.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

Mesh triangle() {
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  mesh.triangle_region = {0};
  mesh.lines = {{0, 1}};
  mesh.line_curve = {0};
  mesh.curves = {{1, {}}};
  mesh.regions = {{1, {}}};
  return mesh;
}

std::string complaint(const std::function<void(Mesh&)>& change) {
  Mesh mesh = triangle();
  change(mesh);
  try {
    require_readable(mesh, "here");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(CheckMesh, SaysWhatIsWrongAndWhere) {
  EXPECT_EQ(complaint([](Mesh&) {}), "");
  EXPECT_EQ(complaint([](Mesh& m) { m.triangles[0][1] = 3; }),
            "here: triangle 0 has point 3: there are 3, counted from 0");
  EXPECT_EQ(complaint([](Mesh& m) { m.lines[0][0] = -1; }),
            "here: line 0 has point -1: there are 3, counted from 0");
  EXPECT_EQ(complaint([](Mesh& m) { m.line_curve.clear(); }),
            "here: 1 lines, but 0 numbers that say of which curve they are");
  EXPECT_EQ(complaint([](Mesh& m) { m.triangle_region[0] = 1; }),
            "here: triangle 0 is of region 1: there are 1, counted from 0");
  EXPECT_EQ(complaint([](Mesh& m) { m.points[2].y = NAN; }),
            "here: point 2 is (0, nan, 0): expected finite coordinates");
  EXPECT_EQ(complaint([](Mesh& m) {
              m.named_points = {{3, {1, {"tip"}}}};
            }),
            "here: a name is for point 3: there are 3, counted from 0");
  EXPECT_EQ(
      complaint([](Mesh& m) { m.order = 2; }),
      "here: elements of order 2 and 1 triangles: expected orders 1 to 4, above 1 of lines and quads alone");
  const auto curve = [](Mesh& m) { m.triangles.clear(), m.triangle_region.clear(), m.order = 2; };
  EXPECT_EQ(complaint([&](Mesh& m) { curve(m), m.line_nodes = {2}; }), "");
  EXPECT_EQ(complaint(curve), "here: 1 lines of a higher order, but 0 further nodes: expected 1 for each");
  EXPECT_EQ(complaint([&](Mesh& m) { curve(m), m.line_nodes = {3}; }),
            "here: a line has point 3: there are 3, counted from 0");
}

}  // namespace
}  // namespace delquad
