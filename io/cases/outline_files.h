#pragma once

#include <filesystem>
#include <vector>

#include "delquad/model.h"

namespace delquad {

/// The polygons of a GeoJSON file [RFC 7946]: each ring is a curve of data, inner ones are holes. The name of
/// a feature, of its properties "name", "NAME" or "id", is that of its region, and rings have it with
/// "_outline", "_hole_1" and so on behind it. Lines and points stand in the regions. Throws InputError, with
/// the feature and ring, for what is no such file, and for longitudes and latitudes: those are no lengths.
/// Such are all coordinates within 180 and 90, unless the file has a "crs" of another name.
PlanarModel read_geojson(const std::filesystem::path& path);

/// Points, one a line: x and y, with comments behind '#'. Of an airfoil the first line may be its name, and
/// two counts may follow, of points on the upper side and the lower, both from the nose.
std::vector<Vec2> read_points(const std::filesystem::path& path);

}  // namespace delquad
