// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/geometry/cad/cad_files.h"

namespace delquad {
namespace {

using std::numbers::pi;

const CadOptions kByOutline{.by_outline = true};

/// Both ways lead to the same faces, curves and topology, and to areas and volumes that differ by what the
/// deflection allows.
void expect_same_surface(const SurfaceModel& kernel, const SurfaceModel& own) {
  EXPECT_EQ(check_invariants(own.fine), std::vector<std::string>{});
  expect_sound(own);
  EXPECT_EQ(own.fine.regions.size(), kernel.fine.regions.size());
  EXPECT_EQ(own.fine.curves.size(), kernel.fine.curves.size());
  EXPECT_EQ(own.corners.size(), kernel.corners.size());
  EXPECT_TRUE(own.left_out.empty());
  const SurfaceCounts a = count(kernel.fine), b = count(own.fine);
  EXPECT_EQ(a.euler, b.euler);
  EXPECT_EQ(a.free_sides > 0, b.free_sides > 0);
  EXPECT_EQ(a.crowded_sides > 0, b.crowded_sides > 0);
  constexpr double kSame = 5e-3;
  EXPECT_NEAR(b.area / a.area, 1, kSame);
  if (a.free_sides == 0) {
    EXPECT_NEAR(b.volume / a.volume, 1, kSame);
  }
}

class ExamplesByOutline : public ::testing::TestWithParam<Example> {};

TEST_P(ExamplesByOutline, AreAsByTheKernel) {
  expect_same_surface(read_example(GetParam().name), read_example(GetParam().name, kByOutline));
}

INSTANTIATE_TEST_SUITE_P(All, ExamplesByOutline, ::testing::ValuesIn(example_models()), [](const auto& name) {
  std::string text = name.param.name;
  std::ranges::replace(text, '-', '_');
  return text;
});

class ByOutline : public ::testing::Test {
 protected:
  SurfaceModel read(const TopoDS_Shape& shape, const CadOptions& options = kByOutline) {
    return read_shape(shape, options);
  }
};

TEST_F(ByOutline, PolesSeamsAndApexes) {
  const double most = 0.01;
  const SurfaceCounts sphere = count(read(BRepPrimAPI_MakeSphere(2).Shape()).fine);
  EXPECT_EQ(sphere.euler, 2);
  EXPECT_EQ(sphere.free_sides, 0);
  EXPECT_NEAR(sphere.area / (16 * pi), 1, most);
  EXPECT_NEAR(sphere.volume / (32 * pi / 3), 1, most);
  const SurfaceCounts torus = count(read(BRepPrimAPI_MakeTorus(3, 1).Shape()).fine);
  EXPECT_EQ(torus.euler, 0);
  EXPECT_EQ(torus.free_sides, 0);
  EXPECT_NEAR(torus.area / (12 * pi * pi), 1, most);
  const SurfaceCounts cone = count(read(BRepPrimAPI_MakeCone(1, 0, 2).Shape()).fine);
  EXPECT_EQ(cone.euler, 2);
  EXPECT_NEAR(cone.volume / (2 * pi / 3), 1, most);
}

TEST_F(ByOutline, KeepsToTheDeflectionAndTheAngle) {
  const SurfaceModel model = read(BRepPrimAPI_MakeTorus(3, 1).Shape());
  const double bound = CadOptions{}.deflection * diagonal(model.fine);
  for (const auto& [a, b, c] : model.fine.triangles) {
    const auto& x = model.fine.points;
    const Vec3 middle = 1.0 / 3 * (x[a] + x[b] + x[c]);
    EXPECT_LT(norm(model.projector->to_face(0, middle) - middle), 1.5 * bound);
    for (const int v : {a, b, c}) EXPECT_LT(norm(model.projector->to_face(0, x[v]) - x[v]), 1e-9);
  }
}

TEST_F(ByOutline, EndsAtALimitOfPoints) {
  const SurfaceModel model = read(BRepPrimAPI_MakeTorus(3, 1).Shape(), {.angle = 0.02, .by_outline = true});
  EXPECT_TRUE(is_reported(model.warnings, "more coarsely than asked for"));
  EXPECT_LT(model.fine.triangles.size(), 50'000u);
}

/// Half of a cylinder whose boundary runs along the line where the parameters begin and end, on one side
/// only.
TEST_F(ByOutline, FaceOnOneSideOfASeam) {
  const TopoDS_Shape cylinder = BRepPrimAPI_MakeCylinder(1, 3);
  const TopoDS_Shape half = BRepAlgoAPI_Cut(cylinder, BRepPrimAPI_MakeBox(gp_Pnt(-2, -2, -1), 4, 2, 5));
  for (const CadOptions& options : {CadOptions{}, kByOutline}) {
    const SurfaceModel model = read(half, options);
    expect_sound(model);
    EXPECT_EQ(count(model.fine).free_sides, 0);
    EXPECT_NEAR(count(model.fine).volume / (1.5 * pi), 1, 0.01);
  }
}

}  // namespace
}  // namespace delquad
