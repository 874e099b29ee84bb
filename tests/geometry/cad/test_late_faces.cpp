#include <gtest/gtest.h>

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Builder.hxx>
#include <TopoDS_Compound.hxx>
#include <algorithm>

#include "base/activity.h"
#include "base/context.h"
#include "geometry/cad/cad_reader.h"
#include "tests/geometry/cad/cad_files.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/temporary_folder.h"

namespace delquad {
namespace {

using namespace testing_support;

TopoDS_Compound compound_of(const std::vector<TopoDS_Shape>& shapes) {
  TopoDS_Compound compound;
  const BRep_Builder builder;
  builder.MakeCompound(compound);
  for (const TopoDS_Shape& shape : shapes) builder.Add(compound, shape);
  return compound;
}

/// A box, six faces that take no time, and a torus that takes seconds at this fineness.
class LateFaces : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
  std::filesystem::path file_ =
      write_brep(folder_ / "late.brep",
                 compound_of({BRepPrimAPI_MakeBox(1, 1, 1).Shape(), BRepPrimAPI_MakeTorus(20, 5).Shape()}));
  CadOptions options_{.deflection = 1e-6, .face_seconds = 0.2};
};

TEST_F(LateFaces, AreNamed) {
  const RunScope run;
  expect_input_error([&] { read_cad(file_, options_); },
                     {"late.brep", "cannot be triangulated in the time that a face may take: face 7"});
  EXPECT_EQ(current_activities()->faces_text(), "");
}

TEST_F(LateFaces, AreLeftOutWhereOthersRemain) {
  options_.keep_going = true;
  const SurfaceModel model = read_cad(file_, options_);
  ASSERT_EQ(model.left_out.size(), 1u);
  EXPECT_EQ(model.left_out[0].face, 6);
  EXPECT_EQ(model.left_out[0].reason, "face 7: cannot be triangulated in the time that a face may take");
  EXPECT_EQ(model.fine.regions.size(), 7u);
  EXPECT_EQ(std::ranges::count(model.fine.triangle_region, 6), 0);
  for (int f = 0; f < 6; ++f) EXPECT_GT(std::ranges::count(model.fine.triangle_region, f), 0) << f;
  EXPECT_EQ(model.fine.curves.size(), 12u);
}

TEST_F(LateFaces, AreNotTheWholeModel) {
  const auto only = write_brep(folder_ / "torus.brep", BRepPrimAPI_MakeTorus(20, 5).Shape());
  options_.keep_going = true;
  expect_input_error([&] { read_cad(only, options_); }, {"torus.brep", "face 1"});
}

TEST(LateHealing, IsLeftOut) {
  const TemporaryFolder folder;
  std::vector<TopoDS_Shape> boxes;
  for (int i = 0; i < 300; ++i) boxes.push_back(BRepPrimAPI_MakeBox(gp_Pnt(2.0 * i, 0, 0), 1, 1, 1).Shape());
  const auto file = write_brep(folder / "boxes.brep", compound_of(boxes));
  EXPECT_TRUE(read_cad(file).warnings.empty());
  const SurfaceModel model = read_cad(file, {.healing_seconds = 1e-6});
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_NE(model.warnings[0].text.find("it is taken as it is"), std::string::npos);
  EXPECT_EQ(model.fine.regions.size(), 1800u);
}

}  // namespace
}  // namespace delquad
