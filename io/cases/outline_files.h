// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "delquad/model.h"

// This header reads outlines. Readers and writers use it.

namespace delquad {

/// Reads a GeoJSON file [RFC 7946]. Each ring of a polygon is a curve of data, and inner rings are holes.
/// Without polygons the lines that join at their ends are outlines (join_outlines()); other lines and points
/// lie in the regions. The name of a feature is its property "name", "NAME" or "id". Its region has this
/// name, and its rings have "_outline", "_hole_1" and so on behind it.
///
/// The property "barrier" or "crack" (true) opens the mesh along a line. "boundary" ("open" or "land") and
/// "weir" (true, or the height of the crest) put "_open", "_weir" or "_weir_2.5" behind names of curves.
/// Notes name other values, and properties with similar names.
///
/// Throws InputError, with feature and ring, for other files, and for longitudes and latitudes. These are
/// coordinates within 180 and 90, unless the file has a "crs" of another name.
PlanarModel read_geojson(const std::filesystem::path& path);

/// The parts of "FILE", "FILE:LAYER", "FILE@CRS" and "FILE:LAYER@CRS", where FILE has an extension of
/// outlines.
struct OutlineFile {
  std::filesystem::path path;
  std::string layer;    ///< empty: the only layer
  std::string project;  ///< coordinate system in the syntax of PROJ, or "utm"; empty: not projected
};
/// Returns the file and its layer; nothing for other texts.
std::optional<OutlineFile> outline_file_of(const std::filesystem::path& text);
/// Returns these extensions, for messages.
std::string outline_files();

/// Returns what read_geojson() makes of GeoJSON and of all that GDAL reads, with its coordinate system (see
/// read_raster()). Returns what read_dxf() makes of a drawing, with its unit. Throws InputError in builds
/// without GDAL for all but GeoJSON as it is.
Model read_outlines(const OutlineFile& file, std::string& crs, std::string& unit);

/// Returns points from lines "x y", with comments behind '#'. The first line may be the name of an airfoil.
/// Two counts may follow, of points on the upper and on the lower side, both from the nose. Throws InputError
/// with file and line.
std::vector<Vec2> read_points(const std::filesystem::path& path);

}  // namespace delquad
