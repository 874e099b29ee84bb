#include "io/cases/outline_files.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace delquad
