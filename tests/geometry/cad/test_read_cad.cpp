// SPDX-License-Identifier: GPL-3.0-or-later
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepLib.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <GCE2d_MakeSegment.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <Geom2d_TrimmedCurve.hxx>
#include <Geom_CylindricalSurface.hxx>
#include "tests/geometry/cad/cad_files.h"

namespace delquad {
namespace {

using std::numbers::pi;

/// Tolerance of area and volume against closed forms: the triangulation is as fine as 0.15 radians.
constexpr double kFine = 4e-3;

struct Solid {
  const char* name;
  TopoDS_Shape shape;
  int faces, curves, corners, euler;
  double area, volume;
};

Solid box() { return {"box", BRepPrimAPI_MakeBox(2, 3, 4), 6, 12, 8, 2, 52, 24}; }
Solid cylinder() {
  return {"cylinder", BRepPrimAPI_MakeCylinder(2, 5), 3, 2, 0, 2, 2 * pi * 2 * (2 + 5), pi * 4 * 5};
}
Solid sphere() { return {"sphere", BRepPrimAPI_MakeSphere(3), 1, 0, 0, 2, 4 * pi * 9, 4 * pi * 27 / 3}; }
Solid torus() {
  return {"torus", BRepPrimAPI_MakeTorus(5, 2), 1, 0, 0, 0, 4 * pi * pi * 10, 2 * pi * pi * 5 * 4};
}
Solid cone() {
  return {"cone", BRepPrimAPI_MakeCone(3, 0, 4), 2, 1, 0, 2, pi * 9 + pi * 3 * 5, pi * 9 * 4 / 3};
}
Solid frustum() {
  return {"frustum",
          BRepPrimAPI_MakeCone(3, 1, 4),
          3,
          2,
          0,
          2,
          pi * (9 + 1) + pi * 4 * std::sqrt(20.0),
          pi * 4 * (9 + 3 + 1) / 3};
}

class Primitives : public ::testing::TestWithParam<Solid> {};

TEST_P(Primitives, KeepTheirTopologyThroughAllFormats) {
  const Solid& solid = GetParam();
  const TemporaryFolder folder;
  for (const auto& path :
       {write_brep(folder / "a.brep", solid.shape), write_step(folder / "a.step", solid.shape),
        write_iges(folder / "a.igs", solid.shape)}) {
    SCOPED_TRACE(path);
    const SurfaceModel model = read_cad(path);
    EXPECT_EQ(check_invariants(model.fine), std::vector<std::string>{});
    expect_sound(model);
    EXPECT_EQ(texts(model.warnings), std::vector<std::string>{});
    EXPECT_EQ(model.fine.regions.size(), static_cast<std::size_t>(solid.faces));
    EXPECT_EQ(model.fine.curves.size(), static_cast<std::size_t>(solid.curves));
    EXPECT_EQ(model.corners.size(), static_cast<std::size_t>(solid.corners));
    const SurfaceCounts n = count(model.fine);
    EXPECT_EQ(n.euler, solid.euler);
    EXPECT_EQ(n.free_sides, 0);
    EXPECT_NEAR(n.area / solid.area, 1, kFine);
    EXPECT_NEAR(n.volume / solid.volume, 1, 2 * kFine);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Primitives,
                         ::testing::Values(box(), cylinder(), sphere(), torus(), cone(), frustum()),
                         [](const auto& param) { return param.param.name; });

TEST(ReadCad, GivesTheSameBytesTwice) {
  const TemporaryFolder folder;
  const auto path = write_step(folder / "a.step", torus().shape);
  const SurfaceModel first = read_cad(path), second = read_cad(path);
  EXPECT_EQ(first.fine.points, second.fine.points);
  EXPECT_EQ(first.fine.triangles, second.fine.triangles);
}

TEST(ReadCad, GivesTheSameForEveryNumberOfThreads) {
  for (const char* example : {"bracket", "hood"})
    on_threads({1, 2, 4}, [&] {
      const SurfaceModel model = read_example(example);
      return std::tuple(model.fine.points, model.fine.triangles, model.fine.lines, texts(model.warnings));
    });
}

TEST(ReadCad, TellsTheFormatByContent) {
  const TemporaryFolder folder;
  EXPECT_EQ(read_cad(write_step(folder / "a.brep", box().shape)).fine.regions.size(), 6u);
  EXPECT_EQ(read_cad(write_brep(folder / "a.txt", box().shape)).fine.regions.size(), 6u);
}

TEST(ReadCad, ConvertsTheUnitsOfStepToMillimetres) {
  const TemporaryFolder folder;
  std::string text = read_text(write_step(folder / "a.step", box().shape));
  const std::string millimetre = "SI_UNIT(.MILLI.,.METRE.)";
  ASSERT_NE(text.find(millimetre), std::string::npos);
  for (std::size_t at; (at = text.find(millimetre)) != std::string::npos;)
    text.replace(at, millimetre.size(), "SI_UNIT(.CENTI.,.METRE.)");
  const SurfaceModel model = read_cad(write_text(folder / "b.step", text));
  EXPECT_NEAR(count(model.fine).area, 5200, 1e-9);
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_TRUE(
      holds(model.warnings[0].text, "lengths are in CENTIMETRE: the model, --size and the mesh are in mm"));
}

TEST(ReadCad, HasLengthsInTheUnitThatIsAskedFor) {
  const TemporaryFolder folder;
  for (const auto& path :
       {write_step(folder / "a.step", box().shape), write_iges(folder / "a.igs", box().shape)}) {
    CadOptions options;
    const SurfaceModel plain = read_cad(path, options);
    EXPECT_EQ(plain.fine.unit, "mm");
    EXPECT_EQ(texts(plain.warnings), std::vector<std::string>{});
    options.unit = "cm";
    const SurfaceModel model = read_cad(path, options);
    EXPECT_EQ(model.fine.unit, "cm");
    EXPECT_NEAR(count(model.fine).area, count(plain.fine).area / 100, 1e-12);
    const SurfaceModel bytes = read_cad(CadModel{{}, read_text(path)}, options);
    EXPECT_EQ(bytes.fine.points, model.fine.points);
  }
  CadOptions options;
  options.unit = "m";
  expect_input_error([&] { read_shape(box().shape, options); }, {"a.brep", "do not say their unit"});
}

TEST(ReadCad, DropsAnOldTriangulation) {
  const TopoDS_Shape shape = BRepPrimAPI_MakeSphere(3);
  BRepMesh_IncrementalMesh(shape, 2.0);
  const SurfaceModel model = read_shape(shape);
  EXPECT_NEAR(count(model.fine).area / (36 * pi), 1, kFine);
}

TEST(ReadCad, DeflectionIsRelativeToTheDiagonal) {
  const TemporaryFolder folder;
  const auto path = write_brep(folder / "a.brep", sphere().shape);
  const SurfaceModel coarse = read_cad(path, {.deflection = 1e-2, .angle = 1});
  const SurfaceModel fine = read_cad(path, {.deflection = 1e-3, .angle = 1});
  const double diagonal = 6 * std::sqrt(3.0);
  for (const auto& [model, deflection] : {std::pair{&coarse, 1e-2}, std::pair{&fine, 1e-3}}) {
    double worst = 0;
    for (const auto& [a, b, c] : model->fine.triangles) {
      const auto& p = model->fine.points;
      worst = std::max(worst, 3 - norm(1.0 / 3 * (p[a] + p[b] + p[c])));
    }
    EXPECT_LT(worst, 1.1 * deflection * diagonal);
    EXPECT_GT(worst, 0.1 * deflection * diagonal);
  }
}

TopoDS_Face polygon(const std::vector<gp_Pnt>& points) { return BRepBuilderAPI_MakeFace(wire_of(points)); }

/// A unit square and a face that rises from x on.
SurfaceModel read_two_faces(double x) {
  return read_shape(compound_of({polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}),
                                 polygon({{x, 0, 0}, {2, 0, 1}, {2, 1, 1}, {x, 1, 0}})}));
}

TEST(ReadCad, SewsFacesThatWereNeverJoined) {
  const SurfaceModel model = read_two_faces(1);
  EXPECT_EQ(model.fine.curves.size(), 7u);
  EXPECT_EQ(count(model.fine).euler, 1);
  EXPECT_TRUE(is_reported(model.warnings, "2 of 8 free edges coincided and have been sewn"));
  EXPECT_TRUE(is_reported(model.warnings, "the surface is open: free curves: 6"));
}

TEST(ReadCad, LeavesAGapOpenAndSaysSo) {
  const SurfaceModel model = read_two_faces(1.01);
  EXPECT_EQ(count(model.fine).euler, 2);
  EXPECT_TRUE(is_reported(model.warnings, "free curves: 8 (1, 2, 3, 4, 5, 6, 7, 8)"));
}

TEST(ReadCad, MakesNeighboursAgree) {
  std::vector<TopoDS_Shape> faces = faces_of(box().shape);
  faces[2].Reverse();
  const SurfaceModel model = read_shape(compound_of(faces));
  EXPECT_EQ(check_invariants(model.fine), std::vector<std::string>{});
  EXPECT_TRUE(is_reported(model.warnings, "1 faces were oriented against their neighbors"));
  EXPECT_NEAR(count(model.fine).volume, 24, 1e-9);
}

TEST(ReadCad, TurnsASolidThatIsInsideOut) {
  const SurfaceModel model = read_shape(box().shape.Reversed());
  EXPECT_NEAR(count(model.fine).volume, 24, 1e-9);
  EXPECT_TRUE(is_reported(model.warnings, "inside out"));
}

TEST(ReadCad, KeepsAMirroredInstanceTheRightWayRound) {
  const TemporaryFolder folder;
  gp_Trsf mirror;
  mirror.SetMirror(gp_Ax2({10, 0, 0}, {1, 0, 0}));
  const TopoDS_Shape solid = BRepPrimAPI_MakeCylinder(2, 5);
  const auto path =
      write_brep(folder / "a.brep",
                 compound_of({solid, BRepBuilderAPI_Transform(solid, mirror, /*Copy=*/false).Shape()}));
  const SurfaceModel model = read_cad(path);
  EXPECT_EQ(model.fine.regions.size(), 6u);
  EXPECT_EQ(count(model.fine).euler, 4);
  EXPECT_NEAR(count(model.fine).volume / (2 * pi * 20), 1, kFine);
}

TEST(ReadCad, KeepsAPocketAroundPoles) {
  // Both poles of the sphere lie in the pocket, whose boundary crosses the seam. From STEP the kernel makes
  // the outside of it, the whole sphere once more on top.
  const TemporaryFolder folder;
  const auto cylinder = BRepPrimAPI_MakeCylinder(gp_Ax2({0, 0, -1}, {0, 0, 1}), 1, 2).Shape();
  const auto ball = BRepPrimAPI_MakeSphere(gp_Ax2({0.5, 0.75, -0.25}, {0, 0, 1}), 0.75).Shape();
  const TopoDS_Shape shape = BRepAlgoAPI_Cut(cylinder, ball).Shape();
  const SurfaceModel step = read_cad(write_step(folder / "a.step", shape));
  const SurfaceModel brep = read_shape(shape);
  EXPECT_EQ(check_invariants(step.fine), std::vector<std::string>{});
  expect_sound(step);
  EXPECT_EQ(count(step.fine).euler, 2);
  EXPECT_NEAR(count(step.fine).area, count(brep.fine).area, 0.01 * count(brep.fine).area);
  EXPECT_GT(count(step.fine).volume, 0);
}

TEST(ReadCad, KeepsAStripThatWindsThreeTimes) {
  const TemporaryFolder folder;
  const Handle(Geom_CylindricalSurface) cylinder = new Geom_CylindricalSurface(gp_Ax3(), 1);
  const gp_Pnt2d corners[] = {{0, 0}, {6 * pi, 6}, {6 * pi, 6.5}, {0, 0.5}};
  BRepBuilderAPI_MakeWire wire;
  for (int i = 0; i < 4; ++i)
    wire.Add(BRepBuilderAPI_MakeEdge(GCE2d_MakeSegment(corners[i], corners[(i + 1) % 4]).Value(), cylinder));
  const TopoDS_Face strip = BRepBuilderAPI_MakeFace(cylinder, wire.Wire());
  BRepLib::BuildCurves3d(strip);
  for (const auto& path : {write_step(folder / "a.step", strip), write_brep(folder / "a.brep", strip)}) {
    const SurfaceModel model = read_cad(path);
    EXPECT_FALSE(is_reported(model.warnings, "turned over"));
    EXPECT_EQ(count(model.fine).euler, 1);
    EXPECT_NEAR(count(model.fine).area, 3 * pi, 0.01);
  }
}

TEST(ReadCad, NamesCurvesWhereThreeFacesMeet) {
  BRepBuilderAPI_Sewing sewing(1e-6, true, true, true, /*option4: non-manifold*/ true);
  sewing.Add(polygon({{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}}));
  sewing.Add(polygon({{0, 0, 0}, {0, 1, 0}, {-1, 1, 0}, {-1, 0, 0}}));
  sewing.Add(polygon({{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}}));
  sewing.Perform();
  const SurfaceModel model = read_shape(sewing.SewedShape());
  EXPECT_EQ(count(model.fine).crowded_sides, 1);
  EXPECT_TRUE(is_reported(model.warnings, "more than two faces meet on curves: 1 ("));
}

TEST(ReadCad, GivesTheCommonSideOfHolesToOneCurve) {
  BRepBuilderAPI_MakeFace plate(polygon({{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}}));
  for (const double x : {1, 2}) plate.Add(wire_of({{x, 1, 0}, {x, 2, 0}, {x + 1, 2, 0}, {x + 1, 1, 0}}));
  const TopoDS_Shape wall = polygon({{2, 1, 0}, {2, 2, 0}, {2, 2, -1}, {2, 1, -1}});
  const SurfaceModel model = read_shape(compound_of({plate.Face(), wall}));
  std::set<std::pair<int, int>> lines;
  for (const auto& [a, b] : model.fine.lines)
    EXPECT_TRUE(lines.insert(std::minmax(a, b)).second) << a << " " << b;
  EXPECT_NEAR(count(model.fine).area, 11, 1e-9);
}

TEST(ReadCad, KeepsATinyHole) {
  BRepBuilderAPI_MakeFace face(polygon({{-100, -100, 0}, {100, -100, 0}, {100, 100, 0}, {-100, 100, 0}}));
  const gp_Circ circle(gp_Ax2({3, 4, 0}, {0, 0, -1}), 1e-3);
  face.Add(BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(circle)));
  const SurfaceModel model = read_shape(face.Shape());
  EXPECT_EQ(check_invariants(model.fine), std::vector<std::string>{});
  EXPECT_EQ(model.fine.curves.size(), 5u);
  EXPECT_EQ(count(model.fine).euler, 0);
  EXPECT_GE(std::ranges::count(model.fine.line_curve, 4), 3);
}

TEST(ReadCad, IsWholeUpToACusp) {
  // Two circles that touch in (0, 0). The inner one has the shorter chords in angle, so that its first
  // crosses the outer one's first.
  const auto end = [](double radius, double angle) {
    return gp_Pnt(radius * std::sin(angle), radius * (1 - std::cos(angle)), 0);
  };
  const auto arc = [&](double radius, double angle) {
    const gp_Circ circle(gp_Ax2({0, radius, 0}, {0, 0, 1}), radius);
    return GC_MakeArcOfCircle(circle, gp_Pnt(0, 0, 0), end(radius, angle), true).Value();
  };
  const double outer_angle = pi / 2, inner_angle = 0.44 * pi;
  const TopoDS_Edge outer = BRepBuilderAPI_MakeEdge(arc(60, outer_angle));
  const TopoDS_Edge inner = BRepBuilderAPI_MakeEdge(arc(40, inner_angle));
  const TopoDS_Edge side = BRepBuilderAPI_MakeEdge(end(60, outer_angle), end(40, inner_angle));
  const TopoDS_Face sickle =
      BRepBuilderAPI_MakeFace(gp_Pln(), BRepBuilderAPI_MakeWire(outer, side, inner).Wire());
  const SurfaceModel model = read_shape(sickle, {.deflection = 1e-2});
  EXPECT_EQ(check_invariants(model.fine), std::vector<std::string>{});
  EXPECT_EQ(model.fine.curves.size(), 3u);
  EXPECT_EQ(count(model.fine).euler, 1);
  EXPECT_EQ(count(model.fine).free_sides, static_cast<int>(model.fine.lines.size()));
}

TEST(ReadCad, KeepsNamesAndColours) {
  const TemporaryFolder folder;
  const auto path = write_step(folder / "a.step", box().shape);
  std::string text = read_text(path);
  const auto put = [&](const std::string& before, const std::string& after) {
    const std::size_t at = text.find(before);
    ASSERT_NE(at, std::string::npos) << before;
    text.replace(at, before.size(), after);
  };
  put("MANIFOLD_SOLID_BREP(''", "MANIFOLD_SOLID_BREP('block'");
  put("ADVANCED_FACE(''", "ADVANCED_FACE('inlet'");
  const std::size_t entity = text.rfind('#', text.find("ADVANCED_FACE('inlet'"));
  const std::string face = text.substr(entity, text.find(' ', entity) - entity);
  put("ENDSEC;\nEND-ISO",
      "#9001=STYLED_ITEM('',(#9002)," + face +
          ");\n#9002=PRESENTATION_STYLE_ASSIGNMENT((#9003));\n#9003=SURFACE_STYLE_USAGE(.BOTH.,#9004);\n"
          "#9004=SURFACE_SIDE_STYLE('',(#9005));\n#9005=SURFACE_STYLE_FILL_AREA(#9006);\n"
          "#9006=FILL_AREA_STYLE('',(#9007));\n#9007=FILL_AREA_STYLE_COLOUR('',#9008);\n"
          "#9008=COLOUR_RGB('',1.,0.,0.);\nENDSEC;\nEND-ISO");
  const SurfaceModel model = read_cad(write_text(folder / "b.step", text));
  using Names = std::vector<std::string>;
  int inlets = 0;
  for (const Entity& region : model.fine.regions) {
    EXPECT_TRUE(std::ranges::count(region.names, "block") == 1) << region.tag;
    if (region.names.size() == 1) continue;
    ++inlets;
    Names names = region.names;
    std::ranges::sort(names);
    EXPECT_EQ(names, (Names{"block", "colour #FF0000", "inlet"}));
  }
  EXPECT_EQ(inlets, 1);
}

}  // namespace
}  // namespace delquad
