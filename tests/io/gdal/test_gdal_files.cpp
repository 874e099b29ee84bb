// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/ranges.h>

#include "io/cases/case_file.h"
#include "io/cases/outline_files.h"
#include "io/cases/read_problem.h"
#include "io/gdal/gdal_files.h"
#include "tests/program/program.h"

namespace delquad {
namespace {

constexpr int kUtm31 = 32631, kDegrees4326 = 4326;
/// Corner of the domain of the tests, meters of UTM.
constexpr double kX = 500'000, kY = 5'800'000;

std::string ring(double x, double y, double side) {
  return fmt::format("({0} {1}, {2} {1}, {2} {3}, {0} {3}, {0} {1})", x, y, x + side, y + side);
}
/// A square of 10 km with two islands of 1 km.
std::string sea() {
  return "POLYGON (" + ring(kX, kY, 1e4) + ", " + ring(kX + 2e3, kY + 2e3, 1e3) + ", " +
         ring(kX + 6e3, kY + 6e3, 1e3) + ")";
}

class GdalFiles : public testing::Test {
 protected:
  static void run_gdal(Strings words) {
    const auto result = run_program("/usr/bin/env", {std::move(words), 0, {}});
    EXPECT_EQ(result.exit_code, 0) << result.err;
  }
  static std::string system_of(int code) { return fmt::format("EPSG:{}", code); }

  /// Adds a layer of one feature.
  fs::path write_layer(const std::string& name, const char* driver, const std::string& layer, int code,
                       const std::string& wkt) {
    const fs::path path = folder_ / name;
    const auto table = write_text(folder_ / "feature.csv", "WKT,Name\n\"" + wkt + "\",Nordsee\n");
    Strings words = {"ogr2ogr", "-f", driver, "-nln", layer, "-select", "Name"};
    if (fs::exists(path)) words.emplace_back("-update");
    if (code > 0) words.insert(words.end(), {"-a_srs", system_of(code)});
    words.insert(words.end(), {path, table});
    run_gdal(words);
    if (code == 0) fs::remove(fs::path(path).replace_extension("prj"));
    return path;
  }

  /// Rows from the top.
  fs::path write_tiff(const std::string& name, int code, std::array<double, 6> place, int columns,
                      std::vector<float> values) {
    const fs::path path = folder_ / name;
    const int rows = static_cast<int>(values.size()) / columns;
    const auto text = write_text(folder_ / "values.asc",
                                 fmt::format("ncols {}\nnrows {}\nxllcorner {}\nyllcorner {}\ndx {}\ndy {}\n"
                                             "NODATA_value -9999\n{}\n",
                                             columns, rows, place[0], place[3] + rows * place[5], place[1],
                                             -place[5], fmt::join(values, " ")));
    run_gdal({"gdal_translate", "-q", "-ot", "Float32", "-a_srs", system_of(code), text, path});
    return path;
  }

  PlanarModel read(const std::string& name) {
    return std::get<PlanarModel>(read_outlines(*outline_file_of(folder_ / name), crs_, unit_));
  }

  Folder folder_;
  std::string crs_;
  std::string unit_;
};

TEST_F(GdalFiles, DepthsOfARasterGoIntoMeshesOfCoasts) {
  const auto outline = write_layer("sea.gpkg", "GPKG", "sea", kUtm31, sea());
  // Heights that fall to the east by one in a thousand: -4.5 to -15.5.
  const auto dem =
      write_tiff("dem.tif", kUtm31, {kX - 500, 11000, 0, kY + 1.1e4, 0, -12000}, 2, {-5, -16, -5, -16});
  const auto write = [&](const std::string& file, const std::string& depth) {
    return testing_support::delquad(
        {"mesh", outline, "-o", folder_ / file, "--size", "2000", "--depth", dem.string() + depth});
  };
  ASSERT_EQ(write("a.gr3", ": -value").exit_code, 0);
  std::istringstream in(read_text(folder_ / "a.gr3"));
  std::string title;
  std::getline(in, title);
  std::size_t n_elements = 0, n_nodes = 0;
  in >> n_elements >> n_nodes;
  ASSERT_GT(n_nodes, 20u);
  for (std::size_t i = 0; i < n_nodes; ++i) {
    double number = 0, x = 0, y = 0, depth = 0;
    in >> number >> x >> y >> depth;
    EXPECT_NEAR(depth, std::clamp(5 + (x - kX - 5000) / 1000, 5., 16.), 1e-4);
  }
  EXPECT_EQ(write("a.2dm", "").exit_code, 0);
  EXPECT_TRUE(holds(write("a.msh", "").err, "no depths are written there"));
  EXPECT_TRUE(holds(
      testing_support::delquad({"mesh", outline, "-o", folder_ / "a.gr3", "--size", "2000", "--depth", "10"})
          .err,
      "'10' is no raster"));
}

TEST_F(GdalFiles, NamesSayFileLayerAndCoordinateSystem) {
  const auto whole = outline_file_of("a/b.gpkg:Inseln@EPSG:32631");
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->path, "a/b.gpkg");
  EXPECT_EQ(whole->layer, "Inseln");
  EXPECT_EQ(whole->project, "EPSG:32631");
  EXPECT_EQ(outline_file_of("b.SHP@utm")->project, "utm");
  EXPECT_EQ(outline_file_of("b.SHP@utm")->layer, "");
  EXPECT_FALSE(outline_file_of("b.shp.toml"));
}

TEST_F(GdalFiles, AShapefileIsWhatItsGeoJsonIs) {
  write_layer("sea.shp", "ESRI Shapefile", "sea", kUtm31, sea());
  const PlanarModel model = read("sea.shp");
  EXPECT_EQ(crs_, "EPSG:32631");
  ASSERT_EQ(model.loops.size(), 3u);
  EXPECT_EQ(model.loops[0].region, "Nordsee");
  EXPECT_TRUE(model.loops[1].is_hole && model.loops[2].is_hole);
  EXPECT_EQ(model.curves[2].name, "Nordsee_hole_2");
  EXPECT_TRUE(holds(model.curves[2].where, "sea.shp: feature 1 ('Nordsee'), ring 3"));
  EXPECT_TRUE(model.curves[0].is_data);
  EXPECT_EQ(model.curves[0].shape->point(0), (Vec2{kX, kY}));
}

TEST_F(GdalFiles, LayersGoByNameWhereThereAreSeveral) {
  write_layer("two.gpkg", "GPKG", "sea", kUtm31, sea());
  EXPECT_EQ(read("two.gpkg").loops.size(), 3u);
  write_layer("two.gpkg", "GPKG", "lake", kUtm31, "POLYGON (" + ring(kX, kY, 1) + ")");
  EXPECT_EQ(read("two.gpkg:lake").loops.size(), 1u);
  expect_input_error([&] { read("two.gpkg"); }, {"two.gpkg: there are several layers", "sea, lake"});
  expect_input_error([&] { read("two.gpkg:river"); }, {"no layer 'river'", "sea, lake"});
}

TEST_F(GdalFiles, DegreesAreRefusedOrProjected) {
  write_layer("d.gpkg", "GPKG", "d", kDegrees4326, "POLYGON ((3 52, 3.1 52, 3.1 52.1, 3 52.1, 3 52))");
  expect_input_error([&] { read("d.gpkg"); }, {"d.gpkg: the coordinates are degrees", "d.gpkg@utm"});
  const PlanarModel model = read("d.gpkg@utm");
  EXPECT_EQ(crs_, "EPSG:32631");
  // The central meridian of the zone; 0.9996 of the length of the meridian up to 52 degrees.
  const Vec2 at = model.curves[0].shape->point(0);
  EXPECT_NEAR(at.x, 500'000, 1e-3);
  EXPECT_NEAR(at.y, 0.9996 * 5'763'343.55, 0.5);
  expect_input_error([&] { read("d.gpkg@EPSG:99999999"); },
                     {"d.gpkg", "EPSG:99999999", "no coordinate system"});
  write_layer("none.shp", "ESRI Shapefile", "none", 0, sea());
  EXPECT_EQ(read("none.shp").loops.size(), 3u);
  expect_input_error([&] { read("none.shp@utm"); }, {"none.shp", "names no coordinate system"});
}

TEST_F(GdalFiles, DamagedFilesAreRefused) {
  const auto path = write_layer("cut.shp", "ESRI Shapefile", "cut", kUtm31, sea());
  fs::resize_file(path, fs::file_size(path) / 2);
  expect_input_error([&] { read("cut.shp"); }, {"cut.shp: GDAL: "});
  write_text(folder_ / "text.gpkg", "no such file");
  expect_input_error([&] { read("text.gpkg"); }, {"text.gpkg: GDAL"});
  expect_input_error([&] { read_raster(write_text(folder_ / "text.tif", "none"), ""); }, {"text.tif: GDAL"});
}

TEST_F(GdalFiles, WithoutItsProgramsAnErrorNamesThem) {
  const auto shape = write_text(folder_ / "coast.shp", "");
  const auto result = run_program(
      "/usr/bin/env",
      {{"PATH=/nowhere", DELQUAD_PROGRAM, "mesh", shape, "--size", "1", "-o", folder_ / "a.msh"}, 0, {}});
  EXPECT_NE(result.exit_code, 0);
  EXPECT_TRUE(holds(result.err, "coast.shp", "ogrinfo", "install them (Debian: gdal-bin)"));
}

TEST_F(GdalFiles, RastersAreBilinearBetweenTheMiddlesOfCells) {
  // 3 x 2 cells of 2 m from (10, 20) up; linear in x and y but for the last, which has no data.
  const Raster raster =
      read_raster(write_tiff("a.tif", kUtm31, {10, 2, 0, 24, 0, -2}, 3, {31, 33, -9999, 11, 13, 15}), "");
  EXPECT_DOUBLE_EQ(raster.at({11, 21}), 11);
  EXPECT_DOUBLE_EQ(raster.at({12.5, 21.5}), 17.5);
  EXPECT_DOUBLE_EQ(raster.at({10, 20}), 11);    // constant beyond the middles of the outer cells
  EXPECT_DOUBLE_EQ(raster.at({15, 22.5}), 15);  // of those that have data
  EXPECT_TRUE(std::isnan(raster.at({15, 23})));
  EXPECT_TRUE(raster.grid.covers({16, 24}));
  EXPECT_FALSE(raster.grid.covers({16.1, 24}));
  const Raster ascii = read_raster(write_text(folder_ / "a.asc",
                                              "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n"
                                              "NODATA_value -1\n3 4\n1 -1\n"),
                                   "");
  EXPECT_EQ(ascii.at({0.5, 1.5}), 3);
  EXPECT_TRUE(std::isnan(ascii.at({1.5, 0.5})));
}

TEST_F(GdalFiles, RastersOfOtherCoordinatesAreProjected) {
  // Values are degrees of longitude from the central meridian.
  std::vector<float> values;
  for (int row = 0; row < 10; ++row)
    for (int column = 0; column < 20; ++column)
      values.push_back(0.05f + 0.1f * static_cast<float>(column) - 1);
  const Raster raster =
      read_raster(write_tiff("d.tif", kDegrees4326, {2, 0.1, 0, 53, 0, -0.1}, 20, values), "EPSG:32631");
  EXPECT_NEAR(raster.at({500'000, kY}), 0, 2e-3);
  EXPECT_NEAR(raster.at({500'000 + 0.5 * 68'300, kY}), 0.5, 5e-3);
  EXPECT_FALSE(raster.grid.covers({0.1, 52.5}));
}

/// In one command.
TEST_F(GdalFiles, ASeaWithIslandsAndDepthsBecomesAUgridFile) {
  const auto shape = write_layer("sea.shp", "ESRI Shapefile", "sea", kUtm31, sea());
  // Deeper to the east: 0.1 m to 100.1 m.
  const auto depths =
      write_tiff("depth.tif", kUtm31, {kX - 5e3, 1e4, 0, kY + 1e4, 0, -1e4}, 2, {0.1f, 100.1f});
  const auto mesh_of = [&](const std::string& formula) {
    return testing_support::delquad({"mesh", shape, "--size", depths.string() + ": " + formula, "-o",
                                     folder_ / "sea.nc", "--quality", "fast"});
  };
  const auto result = mesh_of("max(200, 20 * sqrt(9.81 * value))");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Mesh mesh = read_mesh(folder_ / "sea.nc");
  int west = 0, east = 0;
  double area = 0;
  for (const auto& quad : mesh.quads) {
    const Vec3 &a = mesh.points[quad[0]], &c = mesh.points[quad[2]], &b = mesh.points[quad[1]],
               &d = mesh.points[quad[3]];
    area += ((c.x - a.x) * (d.y - b.y) - (c.y - a.y) * (d.x - b.x)) / 2;
    (a.x < kX + 5e3 ? west : east) += 1;
  }
  EXPECT_NEAR(area, 98e6, 1);
  EXPECT_GT(west, 2 * east);
  const auto links = testing_support::delquad({"metrics", folder_ / "sea.nc", "--links"});
  EXPECT_EQ(links.exit_code, 0) << links.err;
  EXPECT_TRUE(holds(links.out, "links of flow"));

  write_tiff("depth.tif", kUtm31, {kX + 1e3, 1e4, 0, kY + 1e4, 0, -1e4}, 2, {1, 100});
  EXPECT_TRUE(holds(mesh_of("value").err, "the raster does not cover (500"));
  write_tiff("depth.tif", kUtm31, {kX, 5e3, 0, kY + 1e4, 0, -1e4}, 2, {-9999, -9999});
  EXPECT_TRUE(holds(mesh_of("value").err, "the raster has no data around (50"));
  EXPECT_TRUE(holds(mesh_of("depth").err, "'depth' is not known (variables: x, y, z, value)"));
}

}  // namespace
}  // namespace delquad
