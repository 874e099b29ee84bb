// SPDX-License-Identifier: GPL-3.0-or-later
#include <BRepAdaptor_Curve.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepFilletAPI_MakeChamfer.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <GC_MakeArcOfCircle.hxx>

#include "base/box.h"
#include "base/text.h"
#include "geometry/mesh/half_edges.h"
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

TopoDS_Shape fused(const std::vector<TopoDS_Shape>& parts) {
  TopoDS_Shape all = parts[0];
  for (std::size_t i = 1; i < parts.size(); ++i) all = BRepAlgoAPI_Fuse(all, parts[i]).Shape();
  return all;
}

/// A prism over a triangle in a plane of constant y, 2 thick.
TopoDS_Shape wedge(const gp_Pnt& a, const gp_Pnt& b, const gp_Pnt& c, double length) {
  return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(wire_of({a, b, c})).Face(), gp_Vec(0, length, 0))
      .Shape();
}

/// The length of the edges with three quads or more, each once, and the number of quads at them.
std::map<std::size_t, double> joints_of(const Mesh& mesh) {
  std::map<std::size_t, double> lengths;
  for_each_edge(sorted_half_edges(mesh), [&](std::span<const HalfEdge> edge) {
    if (edge.size() > 2) lengths[edge.size()] += norm(mesh.points[edge[0].hi] - mesh.points[edge[0].lo]);
  });
  return lengths;
}

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

TEST_F(Midsurface, OfPlatesThatJoin) {
  const auto expect_joint = [&](const TopoDS_Shape& shape, double size, double area,
                                std::vector<double> thicknesses, std::map<std::size_t, double> joints) {
    const Mesh made = expect_half_way(problem(shape, size), area, std::move(thicknesses));
    const auto found = joints_of(made);
    for (const auto& [n, length] : joints)
      EXPECT_NEAR(found.contains(n) ? found.at(n) : 0, length, 1e-6) << n;
    EXPECT_EQ(found.size(), joints.size());
    return made;
  };
  const TopoDS_Shape base = cuboid(0, 0, 0, 60, 40, 2);
  const Mesh tee =
      expect_joint(fused({base, cuboid(29, 0, 2, 3, 40, 30)}), 4, 2400 + 31 * 40, {2, 3}, {{3, 40}});
  for (std::size_t q = 0; q < tee.quads.size(); ++q) {
    const auto [a, b, c, d] = tee.quads[q];
    const bool is_base = std::abs(tee.points[a].z - 1) < 1e-9 && std::abs(tee.points[c].z - 1) < 1e-9;
    EXPECT_NEAR(tee.thickness[q], is_base ? 2 : 3, 1e-6);
    EXPECT_TRUE(is_base || std::abs(tee.points[b].x - 30.5) < 1e-9);
  }
  // A beam, a cross, and a box with an inner wall.
  expect_joint(
      fused({cuboid(0, 0, 0, 40, 100, 3), cuboid(19, 0, 3, 2, 100, 44), cuboid(0, 0, 47, 40, 100, 3)}), 5,
      2 * 4000 + 47 * 100, {2, 3}, {{3, 200}});
  expect_joint(fused({base, cuboid(29, 0, 2, 3, 40, 30), cuboid(29, 0, -30, 3, 40, 30)}), 4,
               2400 + 2 * 31 * 40, {2, 3}, {{4, 40}});
  const TopoDS_Shape box = BRepAlgoAPI_Cut(cuboid(0, 0, 0, 80, 50, 40), cuboid(2, 2, 2, 37, 46, 36)).Shape();
  expect_joint(BRepAlgoAPI_Cut(box, cuboid(41, 2, 2, 37, 46, 36)).Shape(), 5,
               2 * (78 * 48 + 78 * 38 + 48 * 38) + 48 * 38, {2}, {{3, 2 * (48 + 38)}});
  // Ribs on both sides cross, and one ends inside the plate.
  expect_joint(fused({cuboid(0, 0, 0, 100, 80, 3), cuboid(0, 19, 3, 100, 2, 20), cuboid(20, 59, 3, 60, 2, 20),
                      cuboid(49, 0, -15, 2, 80, 15)}),
               5, 8000 + 160 * 21.5 + 80 * 16.5, {2, 3}, {{3, 240}});
  // A corner of two plates with a gusset, and welds beside a stem.
  expect_joint(fused({cuboid(0, 0, 0, 60, 40, 3), cuboid(0, 0, 0, 3, 40, 60),
                      wedge({3, 19, 3}, {43, 19, 3}, {3, 19, 43}, 2)}),
               4, 2 * 58.5 * 40 + 43 * 43 / 2.0, {2, 3}, {{3, 86}});
  expect_joint(fused({base, cuboid(29, 0, 2, 2, 40, 30), wedge({29, 0, 2}, {26, 0, 2}, {29, 0, 5}, 40),
                      wedge({31, 0, 2}, {34, 0, 2}, {31, 0, 5}, 40)}),
               4, 2400 + 31 * 40, {2}, {{3, 40}});
}

TEST_F(Midsurface, OfTubesThatJoinPlates) {
  const auto cylinder = [](double radius) { return BRepPrimAPI_MakeCylinder(radius, 60).Shape(); };
  const TopoDS_Shape fins = BRepAlgoAPI_Cut(cuboid(-35, -0.5, 0, 70, 1, 60), cylinder(19.5)).Shape();
  const TopoDS_Shape tube = BRepAlgoAPI_Cut(cylinder(20), cylinder(19)).Shape();
  const Mesh made = expect_half_way(problem(BRepAlgoAPI_Fuse(tube, fins).Shape(), 3),
                                    2 * pi * 19.5 * 60 + 2 * 15.5 * 60, {1});
  EXPECT_NEAR(joints_of(made)[3], 120, 1e-6);
  const Mesh stood =
      expect_half_way(problem(BRepAlgoAPI_Fuse(tube, cuboid(-50, -50, -2, 100, 100, 2)).Shape(), 3),
                      1e4 + 2 * pi * 19.5 * 61, {1, 2});
  EXPECT_NEAR(joints_of(stood)[3] / (2 * pi * 19.5), 1, 0.005);
}

TEST_F(Midsurface, OfRoundedRims) {
  const auto cylinder = [](double x) {
    return BRepPrimAPI_MakeCylinder(gp_Ax2({x, 0, 1.5}, {0, 1, 0}), 1.5, 50).Shape();
  };
  const Mesh half = expect_half_way(
      problem(fused({cuboid(0, 0, 0, 80, 50, 3), cylinder(0), cylinder(80)}), 3), 83 * 50, {3});
  EXPECT_NEAR(Box<Vec3>::around(half.points).low.x, -1.5, 0.01);
  for (const bool is_round : {false, true}) {
    const TopoDS_Shape plate = cuboid(0, 0, 0, 80, 50, 3);
    BRepFilletAPI_MakeFillet fillet(plate);
    BRepFilletAPI_MakeChamfer chamfer(plate);
    for (TopExp_Explorer edge(plate, TopAbs_EDGE); edge.More(); edge.Next()) {
      const BRepAdaptor_Curve curve(TopoDS::Edge(edge.Current()));
      const double z = curve.Value(curve.FirstParameter()).Z();
      if (z < 2.9 || curve.Value(curve.LastParameter()).Z() < 2.9) continue;
      is_round ? fillet.Add(1, TopoDS::Edge(edge.Current())) : chamfer.Add(1, TopoDS::Edge(edge.Current()));
    }
    expect_half_way(problem(is_round ? fillet.Shape() : chamfer.Shape(), 3), 80 * 50, {3});
  }
}

TEST_F(Midsurface, OfSeveralBodies) {
  const TopoDS_Shape base = cuboid(0, 0, 0, 60, 40, 2), stem = cuboid(29, 0, 2, 3, 40, 30);
  MeshProblem touching = problem(compound_of<TopoDS_Shape>({base, stem}), 4);
  EXPECT_TRUE(joints_of(expect_half_way(touching, 60 * 40 + 30 * 40, {2, 3})).empty());
  touching.surface.glue = true;
  EXPECT_NEAR(joints_of(expect_half_way(touching, 60 * 40 + 31 * 40, {2, 3}))[3], 40, 1e-6);
}

TEST_F(Midsurface, KeepsTheThickness) {
  const Mesh made =
      mesh(problem(fused({cuboid(0, 0, 0, 60, 40, 2), cuboid(29, 0, 2, 3, 40, 30)}), 4), "good").mesh;
  for (const char* name : {"joint.vtu", "joint.msh"}) {
    write_mesh(folder_ / name, made);
    const Mesh back = read_mesh(folder_ / name);
    EXPECT_EQ(back.thickness, made.thickness) << name;
    const Mesh better = mesh(problem_of(GivenMesh{back}), "good").mesh;
    EXPECT_EQ(better.thickness.size(), better.quads.size());
    EXPECT_EQ(std::ranges::count(better.thickness, made.thickness[0]) > 0, true);
  }
}

TEST_F(Midsurface, RefusesWhatHasNone) {
  expect_refused(problem(cuboid(0, 0, 0, 10, 8, 6), 2), "DB", {"face", "thick", "[no-midsurface]"});
  const TopoDS_Shape joint = fused({cuboid(0, 0, 0, 60, 40, 2), cuboid(29, 0, 2, 2, 40, 30)});
  expect_refused(problem(fused({joint, cuboid(0, 0, 2, 20, 40, 1)}), 4), "DB",
                 {"face", "the thickness changes from 2 to 3", "[no-midsurface]"});
  expect_refused(problem(fused({joint, cuboid(5, 5, 2, 15, 15, 15)}), 4), "DB",
                 {"face", "no opposite side, and too wide", "[no-midsurface]"});
  MeshProblem open = problem_of(ExampleModel{"sheet"}, 5);
  open.surface.midsurface = true;
  expect_refused(open, "DB", {"is open at", "[no-midsurface]"});
  MeshProblem curved = problem(sheet_as_solid(), 5);
  curved.order = 2;
  expect_refused(curved, "DB", {"mid-surfaces do not go with curved elements"});
}

}  // namespace
}  // namespace delquad
