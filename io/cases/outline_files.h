// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "delquad/model.h"

// This header reads outlines. Readers and writers use it.

namespace delquad {

/// Reads a GeoJSON file [RFC 7946]. Each ring of a polygon is a curve of data, inner ones are holes. Without
/// polygons the lines that join at their ends are outlines (join_outlines()); else lines and points stand in
/// the regions. A feature has its name from its properties "name", "NAME" or "id". Its region has this name,
/// and its rings have "_outline", "_hole_1" and so on behind it.
///
/// The property "barrier" or "crack" (true) makes the mesh come apart along a line. "boundary" ("open" or
/// "land") and "weir" (true, or the height of the crest) put "_open", "_weir" or "_weir_2.5" behind names of
/// curves. Notes tell of other values, and of properties whose names are nearly these.
///
/// Throws InputError, with the feature and ring, for what is no such file, and for longitudes and latitudes.
/// Such are all coordinates within 180 and 90, unless the file has a "crs" of another name.
PlanarModel read_geojson(const std::filesystem::path& path);

/// The parts of "FILE", "FILE:LAYER", "FILE@CRS" and "FILE:LAYER@CRS", where FILE ends as files of outlines
/// do.
struct OutlineFile {
  std::filesystem::path path;
  std::string layer;    ///< empty: the only one
  std::string project;  ///< coordinate system, as PROJ reads it, or "utm"; empty: as it is
};
/// Returns the file and its layer; nothing for other texts.
std::optional<OutlineFile> outline_file_of(const std::filesystem::path& text);
/// Returns these endings.
std::string outline_files();

/// Returns what read_geojson() makes of GeoJSON and of all that GDAL reads, with its coordinate system (see
/// read_raster()). Returns what read_dxf() makes of a drawing, with its unit. Throws InputError in builds
/// without GDAL for all but GeoJSON as it is.
Model read_outlines(const OutlineFile& file, std::string& crs, std::string& unit);

/// Returns points, one a line: x and y, with comments behind '#'. The first line may be the name of an
/// airfoil. Two counts may follow, of points on the upper side and the lower, both from the nose.
std::vector<Vec2> read_points(const std::filesystem::path& path);

}  // namespace delquad
