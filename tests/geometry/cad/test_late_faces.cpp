// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/activity.h"
#include "tests/geometry/cad/cad_files.h"

namespace delquad {
namespace {

using std::numbers::pi;

/// A box, six faces that take no time, and a torus that takes seconds at this fineness.
class LateFaces : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
  std::filesystem::path file_ =
      write_brep(folder_ / "late.brep",
                 compound_of({BRepPrimAPI_MakeBox(1, 1, 1).Shape(), BRepPrimAPI_MakeTorus(20, 5).Shape()}));
  CadOptions options_{.deflection = 1e-6, .face_seconds = 0.2};
};

TEST_F(LateFaces, AreTriangulatedFromTheirOutlines) {
  const RunScope run;
  const SurfaceModel model = read_cad(file_, options_);
  EXPECT_EQ(current_activities()->faces_text(), "");
  ASSERT_EQ(model.warnings.size(), 2u);
  EXPECT_EQ(
      model.warnings[0].text,
      "the CAD kernel could not triangulate all faces; triangulated from their outlines instead: face 7");
  EXPECT_EQ(model.warnings[1].text,
            "triangulated more coarsely than asked for, which takes too many points: face 7");
  EXPECT_TRUE(model.left_out.empty());
  EXPECT_EQ(model.fine.regions.size(), 7u);
  EXPECT_EQ(model.fine.curves.size(), 12u);
  EXPECT_NEAR(count(model.fine).area / (6 + 400 * pi * pi), 1, 1e-3);
}

TEST_F(LateFaces, MayBeTheWholeModel) {
  const auto only = write_brep(folder_ / "torus.brep", BRepPrimAPI_MakeTorus(20, 5).Shape());
  EXPECT_NEAR(count(read_cad(only, options_).fine).area / (400 * pi * pi), 1, 1e-3);
}

TEST(LateHealing, IsLeftOut) {
  const TemporaryFolder folder;
  std::vector<TopoDS_Shape> boxes;
  for (int i = 0; i < 300; ++i) boxes.push_back(BRepPrimAPI_MakeBox(gp_Pnt(2.0 * i, 0, 0), 1, 1, 1).Shape());
  const auto file = write_brep(folder / "boxes.brep", compound_of(boxes));
  EXPECT_TRUE(read_cad(file).warnings.empty());
  const SurfaceModel model = read_cad(file, {.healing_seconds = 1e-6});
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_TRUE(holds(model.warnings[0].text, "it is taken as it is"));
  EXPECT_EQ(model.fine.regions.size(), 1800u);
}

}  // namespace
}  // namespace delquad
