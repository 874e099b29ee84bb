#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "delquad/model.h"

namespace delquad {

/// The polygons of a GeoJSON file [RFC 7946]: each ring is a curve of data, inner ones are holes. The name of
/// a feature, of its properties "name", "NAME" or "id", is that of its region, and rings have it with
/// "_outline", "_hole_1" and so on behind it. Lines and points stand in the regions. Throws InputError, with
/// the feature and ring, for what is no such file, and for longitudes and latitudes: those are no lengths.
/// Such are all coordinates within 180 and 90, unless the file has a "crs" of another name.
PlanarModel read_geojson(const std::filesystem::path& path);

/// What "FILE", "FILE:LAYER", "FILE@CRS" and "FILE:LAYER@CRS" mean, where FILE ends as files of outlines do.
struct OutlineFile {
  std::filesystem::path path;
  std::string layer;    ///< empty: the only one
  std::string project;  ///< coordinate system, as PROJ reads it, or "utm"; empty: as it is
};
/// Nothing for other texts.
std::optional<OutlineFile> outline_file_of(const std::filesystem::path& text);
/// These endings.
std::string outline_files();

/// What read_geojson() makes of GeoJSON and of all that GDAL reads, and its coordinate system (see
/// read_raster()). Throws InputError in builds without GDAL for all but GeoJSON as it is.
PlanarModel read_outlines(const OutlineFile& file, std::string& crs);

/// Points, one a line: x and y, with comments behind '#'. Of an airfoil the first line may be its name, and
/// two counts may follow, of points on the upper side and the lower, both from the nose.
std::vector<Vec2> read_points(const std::filesystem::path& path);

}  // namespace delquad
