#include "io/cases/outline_files.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "io/cases/case_file.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/temporary_folder.h"

namespace delquad {
namespace {

using testing_support::write_text;

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
  testing_support::TemporaryFolder folder_;
};

TEST_F(OutlineFiles, PolygonsWithHolesLinesAndPoints) {
  const PlanarModel model = read(
      feature("MultiPolygon",
              "[[[[0, 0], [1000, 0], [1000, 0], [1000, 1000], [0, 0]], [[500, 200], [600, 300], [600, 200], "
              "[500, 200]]]]") +
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

TEST_F(OutlineFiles, MessagesNameFeatureAndRing) {
  expect_input_error([&] { read(feature("Polygon", "[[[0, 0], [1, 0], [1, 1], [0, 0]]]")); }, {"degrees"});
  expect_input_error([&] { read(feature("Polygon", "[[[0, 0], [500, 0], [1, 1], [0, 1]]]")); },
                     {"feature 1 ('lake'): a ring has four points"});
  expect_input_error([&] { read(feature("Polygon", "[[[0, 0], [500, 0], [1], [0, 0]]]")); },
                     {"feature 1 ('lake')"});
  std::string nested;
  for (int i = 0; i < 100000; ++i) nested += R"({"type": "GeometryCollection", "geometries": [)";
  for (int i = 0; i < 100000; ++i) nested += "]}";
  expect_input_error([&] { read(nested); }, {"in each other"});
  expect_input_error([&] { read(feature("Polygon", "[[[0, 0], [1e999, 0], [1, 1], [0, 0]]]")); }, {"1e999"});
  expect_input_error([&] { read(feature("Hexagon", "[]")); }, {"'Hexagon'"});
  expect_input_error([&] { read_geojson(write_text(folder_ / "b.geojson", "{")); },
                     {"b.geojson: no GeoJSON"});
}

TEST_F(OutlineFiles, AirfoilsInBothOrders) {
  const auto selig = write_text(folder_ / "s.dat", "RHOMB 1\n1 0\n0.5 0.1\n0 0\n0.5 -0.1\n1 0\n");
  const auto lednicer =
      write_text(folder_ / "l.dat", "RHOMB 1\n3. 3.\n\n0 0\n0.5 0.1\n1 0\n\n0 0\n0.5 -0.1\n1 0\n");
  const std::vector<Vec2> points{{1, 0}, {0.5, 0.1}, {0, 0}, {0.5, -0.1}, {1, 0}};
  EXPECT_EQ(read_points(selig), points);
  EXPECT_EQ(read_points(lednicer), points);
  write_text(folder_ / "wing.toml",
             "curve = { name = \"wing\", spline = \"s.dat\" }\nloop = { curves = [\"wing\"] }\nsize = 0.1\n");
  const Case c = read_model_case(folder_ / "wing.toml");
  EXPECT_EQ(std::get<PlanarModel>(c.model).curves[0].shape->point(0), points[0]);
}

/// Group codes and values, one a line, as the section of entities.
class DxfFiles : public OutlineFiles {
 protected:
  PlanarModel read(const std::string& groups) {
    std::string text = "0\nSECTION\n2\nENTITIES\n" + groups + " 0 ENDSEC 0 EOF";
    std::ranges::replace(text, ' ', '\n');
    std::string crs;
    return read_outlines({write_text(folder_ / "a.dxf", text), "", ""}, crs);
  }
  static std::string line(double x0, double y0, double x1, double y1) {
    return "0 LINE 8 wall 10 " + std::to_string(x0) + " 20 " + std::to_string(y0) + " 11 " +
           std::to_string(x1) + " 21 " + std::to_string(y1) + " ";
  }
};

TEST_F(DxfFiles, ArcsAndSplinesStayWhatTheyAre) {
  // A square of 10 whose last corner is a quarter of a circle of 2, a hole, and a quarter of a circle as a
  // spline.
  const PlanarModel model = read(
      "0 LWPOLYLINE 8 rim 90 5 70 1 10 0 20 0 10 10 20 0 10 10 20 8 42 0.41421356237309503 10 8 20 10 10 0 "
      "20 10 "
      "0 CIRCLE 8 0 10 5 20 5 40 1 "
      "0 SPLINE 8 vane 71 2 40 0 40 0 40 0 40 1 40 1 40 1 41 1 41 0.70710678118654752 41 1 "
      "10 3 20 2 10 3 20 3 10 2 20 3 "
      "0 POINT 8 probe 10 1 20 1");
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

TEST_F(DxfFiles, MistakesAreLocated) {
  const std::string triangle = line(0, 0, 1, 0) + line(1, 0, 1, 1) + line(1, 1, 0, 0);
  expect_input_error([&] { read(triangle + "0 INSERT 8 0 2 chair 10 0 20 0"); },
                     {"a.dxf:", "INSERT: a block"});
  expect_input_error([&] { read("0 LINE 8 0 10 zero 20 0 11 1 21 1"); }, {"a.dxf:10", "group 10 is 'zero'"});
  expect_input_error([&] { read(triangle + line(0, 0, 2, 0) + line(2, 0, 1, 1)); },
                     {"3 curves meet at (", "apart"});
  expect_input_error([&] { read(line(0, 0, 1, 0)); }, {"no curves close up"});
  expect_input_error([&] { read("0 SPLINE 71 3 40 0 40 1 10 0 20 0 10 1 20 1"); },
                     {"SPLINE: a spline of degree 3"});
}

}  // namespace
}  // namespace delquad
