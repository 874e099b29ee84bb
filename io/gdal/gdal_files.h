// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "delquad/mesh.h"

// This header reads files by the programs of GDAL (Debian: gdal-bin). Readers of cases use it. All readers
// throw InputError, also if these programs are not installed.

namespace delquad {

/// A layer of a file of outlines.
struct Outlines {
  std::string geojson;
  std::string crs = {};  ///< coordinate system, "EPSG:32631" or WKT; empty: not given
  bool in_degrees = false;
};

/// Returns a layer by its name (empty: the only one), projected to a coordinate system in the syntax of PROJ.
/// "utm" is the zone of its middle; empty: not projected.
Outlines read_layer(const std::filesystem::path& path, const std::string& layer, const std::string& project);

/// Rows and columns of cells in the plane.
struct RasterGrid {
  int columns = 0, rows = 0;
  std::array<double, 6> to_cells = {};  ///< maps (1, x, y) to column and row; cell (0, 0) is from 0 to 1
  /// Returns column and row, with fractions.
  Vec2 cell_at(Vec2 p) const;
  bool covers(Vec2 p) const;
};

/// The first band of a raster.
struct Raster {
  RasterGrid grid;
  std::vector<float> values;  ///< row by row; NaN: no data

  /// Returns the bilinear interpolation between middles of cells with data, constant beyond the outer ones;
  /// NaN if none of four has data.
  double at(Vec2 p) const;
};

/// Reads a raster, projected to `crs` if both systems are known and differ.
Raster read_raster(const std::filesystem::path& path, const std::string& crs);
bool is_raster_file(const std::filesystem::path& path);

}  // namespace delquad
