// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/gdal/gdal_files.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <set>

#include "base/located.h"
#include "base/system.h"
#include "base/text.h"
#include "base/utf8.h"
#include "base/worker_process.h"
#include "io/mesh_io.h"

namespace delquad {

namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

constexpr unsigned kSeconds = 600;  // processor time: far more than files need
constexpr double kMostCells = 1 << 28;

/// The text between two others; empty without the first, to the end without the second.
std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t at = text.find(begin);
  if (at == std::string::npos) return "";
  const std::size_t first = at + begin.size();
  return text.substr(first, text.find(end, first) - first);
}

/// Output of a program of GDAL, which makes a file or, where it says `opens`, tells of one. It then may print
/// errors of what it can do without.
std::string run_gdal(const Words& words, const std::string& opens = "") {
  ProgramEnd end{};
  try {
    end = run_to_end(words, kSeconds);
  } catch (const InputError& error) {
    refuse("{}: GDAL's programs read this file: install them (Debian: gdal-bin) [no-gdal]", error.what());
  }
  std::string text = as_utf8(end.printed);
  const std::string error = between(between(text, "ERROR ", "\n"), ": ", "\n");
  if (end.exit_code == 0 && (error.empty() || !opens.empty())) return text;
  if (!error.empty()) refuse("GDAL: {}", error);
  if (end.exit_code < 0) refuse("GDAL crashes or does not end: expected an undamaged file");
  if (opens.empty()) refuse("GDAL: {} fails", words[0]);
  refuse("GDAL knows no {} of this kind", opens);
}

/// The WKT of a coordinate system.
std::string system_named(const std::string& name) try {
  return std::string(trimmed(run_gdal({"gdalsrsinfo", "-o", "wkt2_2019", name})));
} catch (const InputError&) {
  refuse(
      "'{}' is no coordinate system that PROJ knows: expected \"utm\" or one such as EPSG:32631 "
      "[unknown-projection]",
      name);
}

/// "EPSG:32631", which WKT has at its end: ID["EPSG",32631]] or AUTHORITY["EPSG","32631"]]; else all of it.
std::string name_of(const std::string& wkt) {
  const std::size_t at = wkt.rfind('[');
  if (at == std::string::npos ||
      !(wkt.substr(0, at).ends_with("ID") || wkt.substr(0, at).ends_with("AUTHORITY")))
    return wkt;
  std::string code = wkt.substr(at + 1);
  if (std::ranges::count(code, ']') != 2) return wkt;
  std::erase_if(code, [](char c) { return c == '"' || c == ']'; });
  std::ranges::replace(code, ',', ':');
  return code;
}

/// Longitude and latitude. "BASEGEOGCRS" is part of a projected system.
bool is_geographic(const std::string& wkt) {
  return wkt.find("GEOGCRS[") != std::string::npos && wkt.find("PROJCRS[") == std::string::npos;
}

struct Layer {
  std::string name;
  std::string extent;  ///< "(0.0, 1.0) - (2.0, 3.0)"; empty: there is nothing in it
  std::string system;  ///< WKT; empty: the file says none
};

/// The zone in which the middle of the layer lies.
std::string utm_of(const Layer& layer) {
  double low[2], high[2], x = 0, y = 0;
  if (std::sscanf(layer.extent.c_str(), "(%lf, %lf) - (%lf, %lf)", &low[0], &low[1], &high[0], &high[1]) != 4)
    refuse("the layer is empty: expected lines or polygons");
  const std::string middle = run_gdal(
      {"gdaltransform", "-s_srs", name_of(layer.system), "-t_srs", "EPSG:4326", "-output_xy", "-coord",
       fmt::format("{}", (low[0] + high[0]) / 2), fmt::format("{}", (low[1] + high[1]) / 2)});
  if (std::sscanf(middle.c_str(), "%lf %lf", &x, &y) != 2)
    refuse("its center has no longitude and latitude: check its coordinate system");
  constexpr int kNorth = 32600, kSouth = 32700, kZones = 60, kZone = 6, kFirst = -180;
  const int zone = static_cast<int>(std::floor((x - kFirst) / kZone)) % kZones + 1;
  return fmt::format("EPSG:{}", (y < 0 ? kSouth : kNorth) + zone);
}

Layer layer_of(const std::string& file, const std::string& name) {
  if (std::error_code unknown; !fs::exists(file, unknown) && !file.starts_with("/vsi"))
    refuse("{}", cannot_be_read("no such file"));
  const std::string kBegin = "\nLayer name: ";
  const std::string info =
      run_gdal({"ogrinfo", "-ro", "-so", "-al", "-wkt_format", "wkt2_2019", file}, "outlines");
  Words names;
  for (std::size_t at = info.find(kBegin), next = 0; at != std::string::npos; at = next) {
    next = info.find(kBegin, at + 1);
    const std::string part = info.substr(at, next - at);
    names.push_back(between(part, kBegin, "\n"));
    Layer layer = {names.back(), between(between(part, "\nExtent", "\n"), ": ", "\n"),
                   between(part, "SRS WKT", "\nData axis")};
    layer.system.erase(0, layer.system.find('\n') + 1);
    if (layer.system.starts_with("(unknown)")) layer.system.clear();
    if (name == layer.name || (name.empty() && names.size() == 1 && next == std::string::npos)) return layer;
  }
  if (names.empty()) refuse("there is no layer [several-layers]");
  refuse("{}: expected FILE:LAYER with one of {} [several-layers]",
         name.empty() ? "there are several layers" : fmt::format("there is no layer '{}'", name),
         fmt::join(names, ", "));
}

/// The first band of a raster, as XML.
std::string description_of(const std::string& file) {
  return run_gdal({"gdal_translate", "-q", "-of", "VRT", "-b", "1", file, "/vsistdout/"}, "rasters");
}

/// Columns or rows.
int count_in(const std::string& description, const std::string& attribute) {
  return static_cast<int>(as_number(between(description, attribute + "=\"", "\"")).value_or(0));
}

RasterGrid grid_of(const std::string& description) {
  RasterGrid grid{count_in(description, "rasterXSize"), count_in(description, "rasterYSize")};
  if (1. * grid.columns * grid.rows > kMostCells)
    refuse("{} x {} cells: more than {:g}: cut out the part that you need ('gdal_translate -projwin')",
           grid.columns, grid.rows, kMostCells);
  std::array<double, 6> g = {};  // of (1, column, row) to x, then y
  const int n = std::sscanf(between(description, "<GeoTransform>", "<").c_str(),
                            "%lf, %lf, %lf, %lf, %lf, %lf", &g[0], &g[1], &g[2], &g[3], &g[4], &g[5]);
  const double area = g[1] * g[5] - g[2] * g[4];
  if (n != 6 || area == 0) refuse("it has no georeference: expected the place of its cells");
  if (g[2] == 0 && g[4] == 0)  // without the area, which rounds
    grid.to_cells = {-g[0] / g[1], 1 / g[1], 0, -g[3] / g[5], 0, 1 / g[5]};
  else
    grid.to_cells = {(g[2] * g[3] - g[0] * g[5]) / area, g[5] / area,  -g[2] / area,
                     (g[0] * g[4] - g[1] * g[3]) / area, -g[4] / area, g[1] / area};
  return grid;
}

}  // namespace

Outlines read_layer(const fs::path& path, const std::string& layer_name, const std::string& project) {
  return located(path.string(), [&] {
    const std::string file = fs::absolute(path).string();
    const Layer layer = layer_of(file, layer_name);
    std::string system = layer.system;
    Words words = {"ogr2ogr", "-f", "GeoJSON", "-lco", "SIGNIFICANT_FIGURES=17", "-nlt", "CONVERT_TO_LINEAR"};
    if (!project.empty()) {
      if (system.empty())
        refuse("the file names no coordinate system: it cannot be projected to '{}'", project);
      system = system_named(project == "utm" ? utm_of(layer) : project);
      words.insert(words.end(), {"-t_srs", name_of(system)});
    }
    const TemporaryFolder folder;
    const std::string outlines = folder.path() / "outlines.geojson";
    words.insert(words.end(), {outlines, file, layer.name});
    run_gdal(words);
    return Outlines{as_utf8(file_bytes(outlines)), name_of(system), is_geographic(system)};
  });
}

Raster read_raster(const fs::path& path, const std::string& crs) {
  return located(path.string(), [&] {
    std::string file = fs::absolute(path).string(), info = description_of(file);
    RasterGrid grid = grid_of(info);
    const TemporaryFolder folder;
    if (const std::string from = between(info, "<SRS", "</SRS>"); !crs.empty() && !from.empty())
      if (const std::string to = name_of(system_named(crs)); to != name_of(from)) {
        const std::string projected = folder.path() / "projected.tif";
        run_gdal({"gdalwarp", "-q", "-t_srs", to, "-r", "bilinear", "-et", "0", "-wo", "XSCALE=1", "-wo",
                  "YSCALE=1", "-ot", "Float32", "-dstnodata", "nan", file, projected});
        grid = grid_of(info = description_of(file = projected));
      }
    Raster raster{grid, {}};
    const std::string cells = folder.path() / "cells";
    // In a place that is not turned: the format knows few that are.
    run_gdal({"gdal_translate", "-q", "-of", "ENVI", "-ot", "Float32", "-b", "1", "-b", "mask,1", "-a_ullr",
              "0", "1", "1", "0", file, cells});
    const std::string bytes = file_bytes(cells);  // all values, then whether they are some
    const std::size_t n = bytes.size() / (2 * sizeof(float));
    std::vector<float> valid(n);
    raster.values.resize(n);
    std::memcpy(raster.values.data(), bytes.data(), n * sizeof(float));
    std::memcpy(valid.data(), bytes.data() + n * sizeof(float), n * sizeof(float));
    const double scale = as_number(between(info, "<Scale>", "<")).value_or(1);
    const double offset = as_number(between(info, "<Offset>", "<")).value_or(0);
    for (std::size_t i = 0; i < n; ++i)
      raster.values[i] = valid[i] == 0 ? std::numeric_limits<float>::quiet_NaN()
                                       : static_cast<float>(raster.values[i] * scale + offset);
    return raster;
  });
}

bool is_raster_file(const fs::path& path) {
  static const std::set<std::string> kKinds = {".tif", ".tiff", ".asc", ".vrt"};
  return kKinds.count(kind_of_file(path)) > 0;
}

Vec2 RasterGrid::cell_at(Vec2 p) const {
  const auto& g = to_cells;
  return {g[0] + g[1] * p.x + g[2] * p.y, g[3] + g[4] * p.x + g[5] * p.y};
}

bool RasterGrid::covers(Vec2 p) const {
  constexpr double kRounding = 1e-6;  // cells
  const Vec2 c = cell_at(p);
  return c.x >= -kRounding && c.y >= -kRounding && c.x <= columns + kRounding && c.y <= rows + kRounding;
}

double Raster::at(Vec2 p) const {
  const Vec2 c = grid.cell_at(p);
  const double x = std::clamp(c.x - 0.5, 0., grid.columns - 1.);
  const double y = std::clamp(c.y - 0.5, 0., grid.rows - 1.);
  double sum = 0, weights = 0;
  for (const double column : {std::floor(x), std::floor(x) + 1})
    for (const double row : {std::floor(y), std::floor(y) + 1}) {
      const double weight = (1 - std::abs(x - column)) * (1 - std::abs(y - row));
      if (!(weight > 0)) continue;  // perhaps beyond the last
      const float value = values[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns) +
                                 static_cast<std::size_t>(column)];
      if (std::isnan(value)) continue;
      sum += weight * value;
      weights += weight;
    }
  return sum / weights;
}

}  // namespace delquad
