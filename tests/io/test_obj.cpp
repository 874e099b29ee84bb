// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/io/reader_test.h"

namespace delquad {
namespace {

class Obj : public testing_support::ReaderTest<> {
 protected:
  Obj() : ReaderTest("case.obj") {}
};

TEST_F(Obj, ReadsWhatProgramsWrite) {
  const Mesh mesh = read(
      "# a comment\nmtllib x.mtl\no thing\nv 9 9 9\nv 0 0 0\nv 1 0 0 1.0\nvn 0 0 1\nv 1 1 0\nv 0 1 0\nvt 0 "
      "0\n"
      "g plate upper\ns off\nf 2/1/1 3//1 4/1 5\nf -4 -3 -2\ng\nl 2 3 4 5\n");
  EXPECT_EQ(mesh.points, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}))
      << "unused points go";
  EXPECT_EQ(mesh.quads, (Quads{{0, 1, 2, 3}}));
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}}));
  EXPECT_EQ(mesh.lines, (Lines{{0, 1}, {1, 2}, {2, 3}}));
  ASSERT_EQ(mesh.regions.size(), 1u);
  EXPECT_EQ(mesh.regions[0].names, (Strings{"plate", "upper"}));
  ASSERT_EQ(mesh.curves.size(), 1u);
  EXPECT_TRUE(mesh.curves[0].names.empty());
}

TEST_F(Obj, ReadsPointsOfThePlane) {
  const Mesh mesh = read("v 0 0\nv 2 0 # with a comment\nv 2 1\nv 0 1\nf 1 2 3 4 # and here\n");
  EXPECT_EQ(mesh.points, (std::vector<Vec3>{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.quads.size(), 1u);
}

TEST_F(Obj, LinesGoOnBehindABackslash) {
  const Mesh mesh = read(
      "# no more: \\\nv 0 0 \\\n 0\r\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 \\\r\n 2\\\n 3 4\ng a \\\n b\nf 1 2 "
      "3\n");
  EXPECT_EQ(mesh.points.size(), 4u);
  EXPECT_EQ(mesh.quads, (Quads{{0, 1, 2, 3}}));
  EXPECT_EQ(mesh.regions[1].names, (Strings{"a", "b"}));
  expect_error("v 0 0 0\nv 1 0 0\nf 1 \\\n 2 \\\n 9\n", {"case.obj:5: ", "'9'"});
}

TEST_F(Obj, NamesTheLineOfWhatIsWrong) {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
  expect_error("v 0 0\nv 1 0 0\n", {"case.obj:2: ", "expected two coordinates"});
  expect_error("v 0 0 0\nv 1 0\n", {"case.obj:2: ", "expected three coordinates"});
  expect_error("v 0\n", {"case.obj:1: ", "coordinates"});
  expect_error("v 0 x 0\n", {"case.obj:1: ", "'x'"});
  expect_error("v 0 inf 0\n", {"case.obj:1: ", "finite"});
  expect_error(points + "f 1 2 4\n", {"case.obj:4: ", "from 1 to 3", "'4'"});
  expect_error(points + "f 1 2 0\n", {"case.obj:4: ", "'0'"});
  expect_error(points + "f 1 2 -4\n", {"case.obj:4: ", "'-4'"});
  expect_error(points + "f 1 2 3x\n", {"case.obj:4: ", "'3x'"});
  expect_error(points + "f 1 2\n", {"case.obj:4: ", "face of 2 vertices"});
  expect_error(points + "f 1 2 3 1 2\n", {"case.obj:4: ", "face of 5 vertices"});
  expect_error(points + "l 1\n", {"case.obj:4: ", "two vertices"});
  expect_error(points, {"case.obj:", "no lines and no faces"});
}

}  // namespace
}  // namespace delquad
