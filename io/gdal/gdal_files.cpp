#include "io/gdal/gdal_files.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include "base/find_program.h"
#include "base/located.h"
#include "base/worker_process.h"
#include "io/gdal/gdal_request.h"
#include "io/mesh_io.h"

namespace delquad {

namespace {

/// What the worker replies, of the kind that was asked for.
std::string ask_gdal(char kind, const std::filesystem::path& path, const std::string& first,
                     const std::string& second) {
#ifndef DELQUAD_HAS_GDAL
  refuse("{}: built without GDAL (Debian's libgdal-dev): cannot read it", path.string());
#endif
  return located(path.string(), [&] {
    std::string result;
    char heard = 0;
    WorkerProcess worker(find_program(
        {"delquad-gdal", "outlines and rasters (archive and wheel lack it)", "DELQUAD_GDAL_WORKER"}));
    worker.ask(gdal_request(kind, {path.string(), first, second}), [&](char reply, const std::string& text) {
      heard = reply;
      result = text;
    });
    if (heard == kMessage) throw InputError(result);
    if (heard != kind) throw InputError("damaged: GDAL crashes or finds no end");
    return result;
  });
}

}  // namespace

Outlines read_layer(const std::filesystem::path& path, const std::string& layer, const std::string& project) {
  std::string text = ask_gdal(kAskOutlines, path, layer, project);
  const std::size_t end = text.find('\0');
  return {text.substr(end + 1), text.substr(1, end - 1), text[0] == kDegrees};
}

Raster read_raster(const std::filesystem::path& path, const std::string& crs) {
  const std::string text = ask_gdal(kAskRaster, path, crs, "");
  Raster raster;
  std::memcpy(&raster.grid, text.data(), sizeof raster.grid);
  raster.values.resize((text.size() - sizeof raster.grid) / sizeof(float));
  std::memcpy(raster.values.data(), text.data() + sizeof raster.grid, raster.values.size() * sizeof(float));
  return raster;
}

bool is_raster_file(const std::filesystem::path& path) {
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
