// SPDX-License-Identifier: GPL-3.0-or-later
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <GC_MakeArcOfCircle.hxx>

#include "base/text.h"
#include "io/mesh_io.h"
#include "tests/geometry/cad/cad_files.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

using std::numbers::pi;

constexpr double kThick = 1.5, kRadius = 6, kLong = 100, kHigh = 40, kWide = 60;

TopoDS_Shape cuboid(double x, double y, double z, double dx, double dy, double dz) {
  return BRepPrimAPI_MakeBox(gp_Pnt(x, y, z), dx, dy, dz).Shape();
}

TopoDS_Shape without_cylinder(const TopoDS_Shape& shape, const gp_Pnt& at, const gp_Dir& along, double radius,
                              double length) {
  return BRepAlgoAPI_Cut(shape, BRepPrimAPI_MakeCylinder(gp_Ax2(at, along), radius, length).Shape()).Shape();
}

/// The example "sheet" as a solid, without its pinhole.
TopoDS_Shape sheet_as_solid() {
  const double outer = kRadius + kThick;
  const auto at = [](double x, double z) { return gp_Pnt(x, 0, z); };
  const auto on_bend = [&](double r) { return at(kLong + r * std::sqrt(0.5), outer - r * std::sqrt(0.5)); };
  BRepBuilderAPI_MakeWire outline;
  const auto line = [&](const gp_Pnt& a, const gp_Pnt& b) { outline.Add(BRepBuilderAPI_MakeEdge(a, b)); };
  const auto arc = [&](const gp_Pnt& a, const gp_Pnt& b, const gp_Pnt& c) {
    outline.Add(BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(a, b, c).Value()));
  };
  line(at(0, 0), at(kLong, 0));
  arc(at(kLong, 0), on_bend(outer), at(kLong + outer, outer));
  line(at(kLong + outer, outer), at(kLong + outer, kHigh));
  line(at(kLong + outer, kHigh), at(kLong + kRadius, kHigh));
  line(at(kLong + kRadius, kHigh), at(kLong + kRadius, outer));
  arc(at(kLong + kRadius, outer), on_bend(kRadius), at(kLong, kThick));
  line(at(kLong, kThick), at(0, kThick));
  line(at(0, kThick), at(0, 0));
  TopoDS_Shape sheet =
      BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(outline.Wire()).Face(), gp_Vec(0, kWide, 0)).Shape();
  for (const double y : {18.0, 42.0}) sheet = without_cylinder(sheet, {25, y, -1}, {0, 0, 1}, 5, 4);
  for (const double x : {60.0, 70.2}) sheet = without_cylinder(sheet, {x, 30, -1}, {0, 0, 1}, 5, 4);
  sheet = BRepAlgoAPI_Cut(sheet, cuboid(-1, kWide - 0.3, -1, 46, 1, 4)).Shape();
  return without_cylinder(sheet, {kLong - 5, 30, 24}, {1, 0, 0}, 8, 30);
}

class Midsurface : public ::testing::Test {
 protected:
  MeshProblem problem(const TopoDS_Shape& shape, double size) {
    MeshProblem made = problem_of(CadModel{write_step(folder_ / "part.step", shape)}, size);
    made.surface.midsurface = true;
    return made;
  }
  /// The mesh half-way: its area, and each thickness that is allowed, to 0.5 % and 1 %.
  static Mesh expect_half_way(const MeshProblem& problem, double area, std::vector<double> thicknesses) {
    const MeshResult result = mesh(problem, "good");
    const Mesh& made = result.mesh;
    double sum = 0;
    EXPECT_EQ(made.thickness.size(), made.quads.size());
    for (std::size_t q = 0; q < made.quads.size(); ++q) {
      const auto x = [&](int k) { return made.points[made.quads[q][k]]; };
      sum += norm(cross(x(2) - x(0), x(3) - x(1))) / 2;
      EXPECT_TRUE(std::ranges::any_of(thicknesses, [&](double t) {
        return std::abs(made.thickness[q] / t - 1) < 0.01;
      })) << made.thickness[q];
    }
    EXPECT_NEAR(sum / area, 1, 0.005);
    EXPECT_TRUE(result.soundness.sound()) << result.soundness.text();
    return made;
  }

  TemporaryFolder folder_;
};

TEST_F(Midsurface, OfAnAngleWithBendAndHoles) {
  MeshProblem sheet = problem(sheet_as_solid(), 3);
  sheet.surface.names = {{.name = "clamp", .rule = {.box = {{Vec3{0, 0, 0}, Vec3{0, kWide, kThick}}}}},
                         {.name = "below", .rule = {.normal = Vec3{0, 0, -1}}},
                         {.name = "above", .rule = {.at = Vec3{50, 30, kThick}}}};
  const double bend = pi / 2 * (kRadius + kThick / 2);
  const Mesh made = expect_half_way(
      sheet, kWide * (kLong + bend + kHigh - kRadius - kThick) - pi * (4 * 5 * 5 + 8 * 8) - 45 * 0.3,
      {kThick});
  for (const Vec3& x : made.points) {
    const double across = x.x < kLong ? x.z - kThick / 2
                          : x.z > kRadius + kThick
                              ? x.x - kLong - kRadius - kThick / 2
                              : std::hypot(x.x - kLong, x.z - kRadius - kThick) - kRadius - kThick / 2;
    EXPECT_NEAR(across, 0, 1e-6);
  }
  const auto has_both = [](const Entity& region) {
    return std::ranges::count(region.names, "below") + std::ranges::count(region.names, "above") == 2;
  };
  EXPECT_EQ(std::ranges::count_if(made.regions, has_both), 1);
  std::size_t clamped = 0;
  for (const int c : made.line_curve) clamped += std::ranges::count(made.curves[c].names, "clamp");
  EXPECT_NEAR(static_cast<double>(clamped), kWide / 3, 2);
}

TEST_F(Midsurface, OfFoldsWithoutRadius) {
  TopoDS_Shape channel = BRepAlgoAPI_Cut(cuboid(0, 0, 0, 40, 50, 20), cuboid(2, -1, 2, 36, 52, 20)).Shape();
  const Mesh made = expect_half_way(problem(channel, 4), (38 + 2 * 19) * 50, {2});
  const auto at_fold = [](const Vec3& x) { return std::abs(x.x - 1) < 1e-9 && std::abs(x.z - 1) < 1e-9; };
  EXPECT_GT(std::ranges::count_if(made.points, at_fold), 10);
}

TEST_F(Midsurface, OfATubeAndOfAPlateWithHoles) {
  const TopoDS_Shape tube =
      without_cylinder(BRepPrimAPI_MakeCylinder(20, 50).Shape(), {0, 0, -1}, {0, 0, 1}, 19, 52);
  expect_half_way(problem(tube, 3), 2 * pi * 19.5 * 50, {1});
  TopoDS_Shape plate = cuboid(0, 0, 0, 80, 50, 3);
  for (const double x : {20.0, 40.0, 60.0}) plate = without_cylinder(plate, {x, 25, -1}, {0, 0, 1}, 6, 5);
  expect_half_way(problem(plate, 2), 80 * 50 - 3 * pi * 36, {3});
}

TEST_F(Midsurface, OfAStep) {
  const TopoDS_Shape stepped =
      BRepAlgoAPI_Fuse(cuboid(0, 0, 0, 60, 40, 1), cuboid(0, 0, 1, 31, 40, 1)).Shape();
  const Mesh made = expect_half_way(problem(stepped, 4), 60 * 40, {1, 2});
  double thick = 0;
  for (std::size_t q = 0; q < made.quads.size(); ++q) {
    const auto x = [&](int k) { return made.points[made.quads[q][k]]; };
    if (made.thickness[q] > 1.5) thick += norm(cross(x(2) - x(0), x(3) - x(1))) / 2;
  }
  EXPECT_NEAR(thick / (31 * 40), 1, 0.01);
  for (const char* name : {"step.vtu", "step.msh"}) {
    write_mesh(folder_ / name, made);
    const auto fields = read_fields(folder_ / name).fields;
    const auto at = std::ranges::find(fields, "thickness", &MeshField::name);
    ASSERT_NE(at, fields.end()) << name;
    EXPECT_EQ(at->values, made.thickness) << name;
  }
  write_mesh(folder_ / "step.bdf", made);
  EXPECT_TRUE(holds(file_bytes(folder_ / "step.bdf"), "PSHELL"));
  EXPECT_EQ(read_mesh(folder_ / "step.bdf").regions.size(), 2U) << "one of each property";
  write_mesh(folder_ / "step.inp", made);
  const std::string deck = file_bytes(folder_ / "step.inp");
  EXPECT_TRUE(holds(deck, "*ELSET, ELSET=thickness_2\n"));
  EXPECT_TRUE(holds(deck, "*SHELL SECTION, ELSET=thickness_1, MATERIAL=SHEET\n1\n"));
}

TEST_F(Midsurface, RefusesWhatHasNone) {
  expect_refused(problem(cuboid(0, 0, 0, 10, 8, 6), 2), "DB", {"face", "thick", "[no-midsurface]"});
  const TopoDS_Shape joint =
      BRepAlgoAPI_Fuse(cuboid(0, 0, 0, 60, 40, 2), cuboid(29, 0, 2, 2, 40, 30)).Shape();
  expect_refused(problem(joint, 4), "DB", {"face", "plates join", "[no-midsurface]"});
  MeshProblem open = problem_of(ExampleModel{"sheet"}, 5);
  open.surface.midsurface = true;
  expect_refused(open, "DB", {"is open at", "[no-midsurface]"});
  MeshProblem curved = problem(sheet_as_solid(), 5);
  curved.order = 2;
  expect_refused(curved, "DB", {"mid-surfaces do not go with curved elements"});
}

}  // namespace
}  // namespace delquad
