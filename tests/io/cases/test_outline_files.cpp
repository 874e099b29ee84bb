// SPDX-License-Identifier: GPL-3.0-or-later
#include "delquad/mesher.h"
#include "geometry/mesh/half_edges.h"
#include "io/cases/case_file.h"
#include "io/cases/outline_files.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

class OutlineFiles : public testing::Test {
 protected:
  std::string feature(const std::string& type, const std::string& coordinates) {
    return R"({"type": "Feature", "properties": {"name": "lake"}, "geometry": {"type": ")" + type +
           R"(", "coordinates": )" + coordinates + "}}";
  }
  PlanarModel read(const std::string& features) {
    return read_geojson(write_text(folder_ / "a.geojson",
                                   R"({"type": "FeatureCollection", "features": [)" + features + "]}"));
  }
  Folder folder_;
};

TEST_F(OutlineFiles, PolygonsWithHolesLinesAndPoints) {
  const PlanarModel model =
      read(feature("MultiPolygon",
                   "[[[[0, 0], [1000, 0], [1000, 0], [1000, 1000], [0, 0]], [[500, 200], [600, 300], [600, "
                   "200], [500, 200]]]]") +
           "," + feature("LineString", "[[700, 100], [800, 200]]") + "," + feature("Point", "[900, 300]"));
  ASSERT_EQ(model.curves.size(), 3u);
  EXPECT_EQ(model.curves[0].shape->fixed_parameters().size(), 2u);
  EXPECT_EQ(model.curves[0].name, "lake_outline");
  EXPECT_EQ(model.curves[1].name, "lake_hole_1");
  EXPECT_EQ(model.curves[2].name, "lake");
  for (const ModelCurve& curve : model.curves) EXPECT_TRUE(curve.is_data);
  ASSERT_EQ(model.loops.size(), 2u);
  EXPECT_EQ(model.loops[0].region, "lake");
  EXPECT_TRUE(model.loops[1].is_hole);
  ASSERT_EQ(model.points.size(), 1u);
  EXPECT_EQ(model.points[0].at, (Vec2{900, 300}));
}

TEST_F(OutlineFiles, LinesThatJoinAtTheirEndsArePolygons) {
  const auto line = [](const std::string& name, const std::string& coordinates) {
    return R"({"type": "Feature", "properties": {"name": ")" + name +
           R"("}, "geometry": {"type": "LineString", "coordinates": )" + coordinates + "}}";
  };
  const std::string bay = line("sea", "[[0, 0], [900, 0]]") + "," +
                          line("east", "[[900, 900], [900, 0.001]]") + "," +
                          line("shore", "[[900, 900], [400, 700], [0, 900], [0, 0]]");
  const PlanarModel model =
      read(bay + "," + line("isle", "[[200, 200], [400, 200], [300, 400], [200, 200]]"));
  ASSERT_EQ(model.loops.size(), 2u);
  EXPECT_EQ(model.loops[0].curves, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(model.loops[1].curves, std::vector<int>{3});
  MeshProblem problem;
  problem.model = model;
  problem.size.field = make_constant_size(80);
  const Mesh made = mesh(problem, "DB").mesh;
  EXPECT_EQ(made.regions.size(), 1u);
  EXPECT_EQ(made.curves[0].names, Strings{"sea"});
  expect_input_error(
      [&] { read(line("sea", "[[0, 0], [900, 0]]") + "," + line("east", "[[900, 9], [0, 9]]")); },
      {"no lines join to one", "curve 'sea'", "ends at (0, 0)", "curve 'east'", "9 from there"});
}

TEST_F(OutlineFiles, PropertiesSayBarriersAndBoundaries) {
  const auto line = [](const std::string& properties, const std::string& coordinates) {
    return R"({"type": "Feature", "properties": {)" + properties +
           R"(}, "geometry": {"type": "LineString", "coordinates": )" + coordinates + "}}";
  };
  const PlanarModel model =
      read(line(R"("name": "sea", "boundary": "open", "barier": true)", "[[0, 0], [900, 0]]") + "," +
           line(R"("boundary": "open")", "[[900, 0], [900, 900]]") + "," +
           line(R"("name": "land", "barrier": "fence")", "[[900, 900], [0, 900], [0, 0]]") + "," +
           line(R"("name": "dam", "barrier": true, "weir": 2.5)", "[[300, 300], [600, 300]]") + "," +
           line(R"("crack": true, "boundary": "administrative")", "[[300, 600], [600, 600]]"));
  Strings names;
  for (const ModelCurve& curve : model.curves) names.push_back(curve.name);
  EXPECT_EQ(names, (Strings{"sea_open", "open", "land", "dam_weir_2.5", "barrier"}));
  EXPECT_EQ(model.loops.size(), 1u);
  EXPECT_EQ(model.loops[0].curves, (std::vector<int>{0, 1, 2}));
  EXPECT_TRUE(model.curves[3].is_crack && model.curves[4].is_crack && !model.curves[2].is_crack);
  ASSERT_EQ(model.notes.size(), 3u);
  for (const auto& [note, part] :
       {std::pair(0, "feature 1: the property 'barier' is true; did you mean 'barrier'?"),
        {1, "feature 3: the property 'barrier' is \"fence\": expected true or false"},
        {2, "'boundary' is \"administrative\": expected open or land"}})
    EXPECT_TRUE(holds(model.notes[static_cast<std::size_t>(note)], part)) << model.notes[0];
}

TEST_F(OutlineFiles, OutlinesThatNearlyTouchAreJoined) {
  const auto polygon = [](const std::string& name, const std::string& ring) {
    return R"({"type": "Feature", "properties": {"name": ")" + name +
           R"("}, "geometry": {"type": "Polygon", "coordinates": [)" + ring + "]}}";
  };
  // They overlap and gape by up to 0.08 of 10000.
  MeshProblem problem;
  problem.model = read(
      polygon("west", "[[0, 0], [5000, 0], [5030, 2000], [5050, 3000], [5000, 6000], [0, 6000], [0, 0]]") +
      "," +
      polygon("east",
              "[[5000.05, 0], [10000, 0], [10000, 6000], [5000, 6000.08], [5024.95, 4500.06], [5049.94, "
              "3000.03], [5029.97, 2000.02], [5015.02, 1000], [5000.05, 0]]"));
  problem.size.field = make_constant_size(400);
  const MeshResult made = mesh(problem, "DBO");
  EXPECT_TRUE(made.soundness.sound());
  EXPECT_EQ(made.mesh.regions.size(), 2u);
  EXPECT_EQ(made.surface, std::nullopt);
  EXPECT_TRUE(holds(made.warnings[0].text, "outlines that nearly touch were joined"));
  double area = 0;
  for (const auto& quad : made.mesh.quads)
    area += 0.5 * norm(cross(made.mesh.points[quad[2]] - made.mesh.points[quad[0]],
                             made.mesh.points[quad[3]] - made.mesh.points[quad[1]]));
  EXPECT_NEAR(area, 6e7, 1e4);
  const auto sides = sorted_half_edges(made.mesh);
  std::size_t outside = 0;
  for_each_edge(sides, [&](std::span<const HalfEdge> at) {
    const Vec3 middle = 0.5 * (made.mesh.points[at[0].lo] + made.mesh.points[at[0].hi]);
    outside += at.size() == 1 && middle.x > 1000 && middle.x < 9000 && middle.y > 500 && middle.y < 5500;
  });
  EXPECT_EQ(outside, 0u);
  problem.surface.weld_tolerance = 0;
  expect_input_error([&] { mesh(problem, "DB"); }, {});
}

TEST_F(OutlineFiles, MessagesNameFeatureAndRing) {
  expect_input_error([&] { read(feature("Polygon", "[[[0, 0], [1, 0], [1, 1], [0, 0]]]")); }, {"degrees"});
  expect_input_error([&] { read(feature("Polygon", "[[[0, 0], [500, 0], [1, 1], [0, 1]]]")); },
                     {"feature 1 ('lake'): the ring is open: it ends at"});
  expect_input_error([&] { read(feature("Polygon", "[[[0, 0], [500, 0], [1], [0, 0]]]")); },
                     {"feature 1 ('lake')"});
  std::string nested;
  for (int i = 0; i < 100000; ++i) nested += R"({"type": "GeometryCollection", "geometries": [)";
  for (int i = 0; i < 100000; ++i) nested += "]}";
  expect_input_error([&] { read(nested); }, {"in each other"});
  expect_input_error([&] { read(feature("Polygon", "[[[0, 0], [1e999, 0], [1, 1], [0, 0]]]")); }, {"1e999"});
  expect_input_error([&] { read(feature("Polygon", "[[[0, 0], [500, 0], [1e99, 1], [0, 0]]]")); },
                     {"feature 1", "below 1e+60"});
  expect_input_error([&] { read(feature("Hexagon", "[]")); }, {"'Hexagon'"});
  expect_input_error([&] { read_geojson(write_text(folder_ / "b.geojson", "{")); },
                     {"b.geojson: no GeoJSON"});
  expect_input_error(
      [&] { read_geojson(write_text(folder_ / "c.geojson", "{\"type\": \"FeatureCollection\"}")); },
      {"c.geojson: no valid GeoJSON: key 'features' not found"});
}

TEST_F(OutlineFiles, AirfoilsInBothOrders) {
  const auto selig = write_text(folder_ / "s.dat", "RHOMB 1\n1 0\n0.5 0.1\n0 0\n0.5 -0.1\n1 0\n");
  const auto lednicer =
      write_text(folder_ / "l.dat", "RHOMB 1\n3. 3.\n\n0 0\n0.5 0.1\n1 0\n\n0 0\n0.5 -0.1\n1 0\n");
  const std::vector<Vec2> points{{1, 0}, {0.5, 0.1}, {0, 0}, {0.5, -0.1}, {1, 0}};
  EXPECT_EQ(read_points(selig), points);
  EXPECT_EQ(read_points(lednicer), points);
  write_text(folder_ / "wing.toml",
             "curve = { name = 'wing', spline = 's.dat' }\nloop = { curves = ['wing'] }\nsize = 0.1\n");
  const Case c = read_model_case(folder_ / "wing.toml");
  EXPECT_EQ(std::get<PlanarModel>(c.model).curves[0].shape->point(0), points[0]);
}

/// Group codes and values, one a line, as the section of entities.
class DxfFiles : public OutlineFiles {
 protected:
  PlanarModel read(const std::string& groups) {
    return std::get<PlanarModel>(read_model("0\nSECTION\n2\nENTITIES\n" + groups));
  }
  Model read_model(const std::string& sections, std::string unit = {}) {
    std::string text = sections + " 0 ENDSEC 0 EOF";
    std::ranges::replace(text, ' ', '\n');
    std::string crs;
    Model model = read_outlines({write_text(folder_ / "a.dxf", text), "", ""}, crs, unit);
    unit_ = unit;
    return model;
  }
  std::string unit_;  ///< of what was read last
  static std::string line(double x0, double y0, double x1, double y1) {
    return "0 LINE 8 wall 10 " + std::to_string(x0) + " 20 " + std::to_string(y0) + " 11 " +
           std::to_string(x1) + " 21 " + std::to_string(y1) + " ";
  }
};

TEST_F(DxfFiles, ArcsAndSplinesStayWhatTheyAre) {
  // A square of 10, whose last corner is a quarter of a circle of 2. It has a hole, and a quarter of a circle
  // as a spline.
  const PlanarModel model = read(
      "0 LWPOLYLINE 8 rim 90 5 70 1 10 0 20 0 10 10 20 0 10 10 20 8 42 0.41421356237309503 10 8 20 10 10 0 "
      "20 10 0 CIRCLE 8 0 10 5 20 5 40 1 0 SPLINE 8 vane 71 2 40 0 40 0 40 0 40 1 40 1 40 1 41 1 41 "
      "0.70710678118654752 41 1 10 3 20 2 10 3 20 3 10 2 20 3 0 POINT 8 probe 10 1 20 1");
  ASSERT_EQ(model.loops.size(), 2u);
  ASSERT_EQ(model.curves.size(), 5u);
  EXPECT_EQ(model.loops[0].curves, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(model.curves[1].name, "rim");
  EXPECT_EQ(model.curves[3].name, "");
  for (const double t : {0., 0.3, 0.5, 1.}) {
    EXPECT_NEAR(norm(model.curves[1].shape->point(t) - Vec2{8, 8}), 2, 1e-14);
    EXPECT_NEAR(norm(model.curves[3].shape->point(t) - Vec2{5, 5}), 1, 1e-14);
    EXPECT_NEAR(norm(model.curves[4].shape->point(t) - Vec2{2, 2}), 1, 1e-14);
  }
  EXPECT_GT(model.curves[1].shape->point(0.5).x, 9);
  EXPECT_EQ(model.curves[4].name, "vane");
  EXPECT_EQ(model.points[0].name, "probe");
}

TEST_F(DxfFiles, EndsThatAreNearAreJoined) {
  const PlanarModel model =
      read(line(0, 0, 10, 0) + line(10, 1e-5, 10, 10) + line(0, 1e-5, 10, 10) + line(5, 1, 6, 2) +
           "0 ARC 8 tip 230 -1 10 -20 20 0 40 1 50 0 51 180 " + line(21, 0, 19, 0));
  ASSERT_EQ(model.loops.size(), 2u);
  EXPECT_EQ(model.loops[0].curves, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(model.curves[0].shape->point(1), model.curves[1].shape->point(0));
  EXPECT_EQ(model.curves[0].shape->point(0), model.curves[2].shape->point(0));
  EXPECT_NEAR(model.curves[4].shape->point(0.5).y, 1, 1e-14);  // seen from below
  EXPECT_EQ(model.loops[1].curves, (std::vector<int>{4, 5}));
}

TEST_F(DxfFiles, BlocksStandWhereTheyAreInserted) {
  // A square of 20 from two blocks, and a row of two holes, mirrored in a block that is turned.
  const PlanarModel model = std::get<PlanarModel>(
      read_model("0 SECTION 2 BLOCKS 0 BLOCK 8 0 2 half 10 5 20 5 " + line(5, 25, 5, 5) +
                 "0 LINE 8 0 10 5 20 5 11 25 21 5 " +
                 "0 ENDBLK 8 0 0 BLOCK 8 0 2 hole 10 0 20 0 0 CIRCLE 8 0 10 0 20 0 40 1 0 ENDBLK 0 BLOCK 8 0 "
                 "2 holes 10 0 20 0 0 INSERT 8 rim 2 hole 10 4 20 0 41 -1 70 2 44 4 0 ENDBLK 0 BLOCK 2 "
                 "unused 0 CIRCLE 40 -1 0 ENDBLK 0 ENDSEC 0 SECTION 2 ENTITIES 0 INSERT 8 foot 2 half 10 0 "
                 "20 0 0 INSERT 8 0 2 half 10 20 20 20 50 180 0 INSERT 8 0 2 holes 10 10 20 3 50 90"));
  ASSERT_EQ(model.loops.size(), 3u);
  EXPECT_EQ(model.loops[0].curves, (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(model.curves[0].name, "wall");
  EXPECT_EQ(model.curves[1].name, "foot");
  EXPECT_NEAR(norm(model.curves[2].shape->point(0) - Vec2{20, 0}), 0, 1e-12);
  EXPECT_EQ(model.curves[4].name, "rim");
  for (const double t : {0., 0.3}) {
    EXPECT_NEAR(norm(model.curves[4].shape->point(t) - Vec2{10, 7}), 1, 1e-12);
    EXPECT_NEAR(norm(model.curves[5].shape->point(t) - Vec2{10, 11}), 1, 1e-12);
  }
  std::string twice = "0 SECTION 2 BLOCKS 0 BLOCK 2 b0 10 0 20 0 " + line(0, 0, 1, 0) + "0 ENDBLK ";
  for (int k = 0; k < 40; ++k)
    twice += "0 BLOCK 2 b" + std::to_string(k + 1) + " 0 INSERT 2 b" + std::to_string(k) + " 70 9 0 ENDBLK ";
  expect_input_error([&] { read_model(twice + "0 ENDSEC 0 SECTION 2 ENTITIES 0 INSERT 2 b12"); },
                     {"more than 1000000 parts"});
  expect_input_error([&] { read_model(twice + "0 ENDSEC 0 SECTION 2 ENTITIES 0 INSERT 2 b40"); },
                     {"16 deep"});
  expect_input_error([&] { read("0 INSERT 8 0 2 chair 10 0 20 0"); }, {"a.dxf:", "no block 'chair'"});
}

TEST_F(DxfFiles, ThreeDimensionalFacesAreASurface) {
  const std::string face = "0 3DFACE 8 roof 10 0 20 0 30 1 11 4 21 0 31 1 12 4 22 3 32 2 13 ";
  const auto model = std::get<TriangleModel>(
      read_model("0 SECTION 2 ENTITIES " + face + "0 23 3 33 2 " + face + "4 23 3 33 2"));
  EXPECT_EQ(model.mesh.quads.size(), 1u);
  EXPECT_EQ(model.mesh.triangles.size(), 1u);
  EXPECT_EQ(model.mesh.points[2], (Vec3{4, 3, 2}));
  EXPECT_EQ(model.mesh.regions[0].names, Strings{"roof"});
}

TEST_F(DxfFiles, TheUnitOfTheHeaderIsKept) {
  const std::string face =
      "0 SECTION 2 ENTITIES 0 3DFACE 10 0 20 0 30 0 11 4 21 0 31 1 12 4 22 3 32 2 13 4 23 3 33 2";
  const auto unit = [&](const std::string& code) {
    const std::string head = "0 SECTION 2 HEADER 9 $INSUNITS 70 " + code + " 9 $EXTMIN 10 0 0 ENDSEC ";
    return std::get<TriangleModel>(read_model(head + face)).mesh.unit;
  };
  EXPECT_EQ(unit("1"), "in");
  EXPECT_EQ(unit("6"), "m");
  EXPECT_EQ(unit("0"), "");
  EXPECT_EQ(unit("99"), "");
  const std::string drawing =
      "0 SECTION 2 HEADER 9 $INSUNITS 70 1 0 ENDSEC 0 SECTION 2 ENTITIES 0 CIRCLE 10 2 20 0 40 1 ";
  for (const auto& [asked, name, x] : {std::tuple{"", "in", 3.}, std::tuple{"mm", "mm", 76.2}}) {
    const auto model = std::get<PlanarModel>(read_model(drawing, asked));
    EXPECT_EQ(unit_, name);
    EXPECT_NEAR(model.curves[0].shape->point(0).x, x, 1e-12);
  }
  expect_input_error([&] { read_model("0 SECTION 2 ENTITIES 0 CIRCLE 10 2 20 0 40 1", "mm"); },
                     {"does not say its unit", "mm"});
}

TEST_F(DxfFiles, FilledAreasAreOutlinesIfThereAreNoOthers) {
  const std::string solid = "0 SOLID 8 pad 10 20 20 0 11 22 21 0 12 20 22 1 13 22 23 1 ";
  // A square as a polyline with an arc, an edge list of a half disk and half an ellipse, and a spline.
  const std::string hatch =
      "0 HATCH 8 fill 10 0 20 0 30 0 2 SOLID 91 3 92 3 72 1 73 1 93 4 10 0 20 0 42 0 10 10 20 0 42 1 10 10 "
      "20 "
      "10 42 0 10 0 20 10 42 0 97 0 92 1 93 2 72 2 10 5 20 5 40 2 50 180 51 360 73 0 72 3 10 5 20 5 11 2 21 "
      "0 40 0.5 50 180 51 360 73 1 97 0 92 1 93 2 72 4 94 2 73 0 74 0 95 6 96 3 40 0 40 0 40 0 40 1 40 1 40 "
      "1 10 2 20 8 10 3 20 9 10 4 20 8 72 1 10 4 20 8 11 2 21 8 97 0 75 0 98 1 10 1 20 1 ";
  const PlanarModel model = read(hatch + solid + "0 HATCH 91 1 92 1 93 1 72 2 10 5");
  ASSERT_EQ(model.loops.size(), 4u);
  ASSERT_EQ(model.curves.size(), 8u);
  EXPECT_EQ(model.curves[0].name, "fill");
  EXPECT_NEAR(norm(model.curves[1].shape->point(0.5) - Vec2{15, 5}), 0, 1e-12);
  EXPECT_NEAR(norm(model.curves[3].shape->point(0.5) - Vec2{5, 7}), 0, 1e-12);  // a clockwise arc
  EXPECT_NEAR(norm(model.curves[4].shape->point(0.5) - Vec2{5, 4}), 0, 1e-12);
  EXPECT_NEAR(norm(model.curves[5].shape->point(0.5) - Vec2{3, 8.5}), 0, 1e-12);
  EXPECT_NEAR(norm(model.curves[7].shape->point(0.5) - Vec2{22, 1}), 0, 1e-12);
  EXPECT_TRUE(holds(model.notes.at(0), "filled areas are the outlines"));
  EXPECT_TRUE(holds(model.notes.at(1), "1 damaged HATCH"));
  const PlanarModel drawn = read("0 CIRCLE 8 rim 10 5 20 5 40 30 " + hatch + solid);
  EXPECT_EQ(drawn.curves.size(), 1u);
  EXPECT_TRUE(holds(drawn.notes.at(0), "1 HATCH, 1 SOLID are left out"));
}

TEST_F(DxfFiles, TheOuterOutlineCountsWhereThreeCurvesMeet) {
  const std::string square = line(0, 0, 5, 0) + line(5, 0, 10, 0) + line(10, 0, 10, 10) +
                             line(10, 10, 5, 10) + line(5, 10, 0, 10) + line(0, 10, 0, 0);
  const PlanarModel model = read(square + line(5, 0, 5, 4) + line(5, 4, 5, 10) + "0 CIRCLE 10 7 20 4 40 1");
  ASSERT_EQ(model.loops.size(), 2u);
  EXPECT_EQ(model.loops[0].curves, (std::vector<int>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(model.loops[1].curves, std::vector<int>{8});
  // Two triangles with a line between them are two outlines, and nothing is around the line.
  const PlanarModel apart = read(line(0, 0, 1, 0) + line(1, 0, 0, 1) + line(0, 1, 0, 0) + line(1, 0, 2, 0) +
                                 line(2, 0, 3, 0) + line(3, 0, 3, 1) + line(3, 1, 2, 0));
  ASSERT_EQ(apart.loops.size(), 2u);
  EXPECT_EQ(apart.loops[0].curves, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(apart.loops[1].curves, (std::vector<int>{3, 4, 5}));
  EXPECT_EQ(apart.curves.size(), 6u);
  const PlanarModel twice = read(square + line(10, 10, 10, 0) + line(10, 0, 10, 10));
  ASSERT_EQ(twice.loops.size(), 1u);
  EXPECT_EQ(twice.loops[0].curves, model.loops[0].curves);
  EXPECT_TRUE(holds(apart.notes.at(0), "1 curve or point outside of all outlines"));
}

TEST_F(DxfFiles, PaperAndMeshesStayOut) {
  const PlanarModel model = read(
      "0 CIRCLE 8 rim 10 5 20 5 40 3 0 CIRCLE 8 sheet 67 1 10 5 20 5 40 9 0 POLYLINE 70 65 0 VERTEX 10 "
      "0 20 0 0 VERTEX 10 20 20 0 0 VERTEX 10 20 20 20 0 SEQEND");
  ASSERT_EQ(model.curves.size(), 1u);
  EXPECT_EQ(model.curves[0].name, "rim");
  EXPECT_TRUE(holds(model.notes.at(0), "1 mesh (POLYLINE) are left out"));
}

TEST_F(DxfFiles, MistakesAreLocated) {
  expect_input_error([&] { read("0 LINE 8 0 10 zero 20 0 11 1 21 1"); }, {"a.dxf:10", "group 10 is 'zero'"});
  expect_input_error(
      [&] { read(line(0, 0, 1, 0) + line(2, 0, 3, 1) + "0 HATCH 8 0 0 HATCH 8 0"); },
      {"no curves close up", "2 damaged HATCH are left out", "LINE) ends at (", "expected ends that meet"});
  expect_input_error([&] { read("0 SPLINE 71 3 40 0 40 1 10 0 20 0 10 1 20 1"); },
                     {"SPLINE: a spline of degree 3"});
}

}  // namespace
}  // namespace delquad
