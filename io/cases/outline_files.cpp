// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cases/outline_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "base/located.h"
#include "base/nearest_name.h"
#include "base/text.h"
#include "geometry/planar/join_outlines.h"
#include "io/cases/dxf_file.h"
#include "io/entity_names.h"
#include "io/gdal/gdal_files.h"
#include "io/mesh_io.h"
#include "io/text_scanner.h"

namespace delquad {
namespace {

using Json = nlohmann::json;

constexpr const char *kGeoJson = ".geojson", *kDxf = ".dxf";
/// All but these by GDAL.
const std::set<std::string> kKinds = {kGeoJson, ".shp", ".gpkg", ".fgb", ".gml",
                                      ".kml",   ".tab", ".mif",  kDxf};

class GeoJsonReader {
 public:
  GeoJsonReader(const std::filesystem::path& path, const Outlines& file) : path_(path.string()) {
    Json root;
    try {
      root = Json::parse(file.geojson);
    } catch (const Json::exception& error) {
      refuse("{}: no GeoJSON: {}", path_, error.what());
    }
    model_.source = path_;
    try {
      read(root, path_, {});
      if (model_.loops.empty())
        if (const std::string loose = join_outlines(model_); model_.loops.empty())
          refuse("{}: there are no polygons, and no lines join to one{} [open-outline]", path_,
                 loose.empty() ? "" : ": " + loose + ": expected ends that meet");
      check_unit(root, file);
    } catch (const Json::exception& error) {
      const std::string text = error.what();  // "[json.exception.out_of_range.403] key 'geometry' not found"
      refuse("{}: no valid GeoJSON: {}", where_, text.substr(text.find("] ") + 2));
    }
  }

  PlanarModel model() { return std::move(model_); }
  const std::string& crs() const { return crs_; }

 private:
  /// The properties of a feature.
  struct Feature {
    std::string name;
    std::string suffix = {};  ///< of names of its curves: "_open", "_weir"
    bool is_barrier = false;
    std::string curve(const std::string& part) const {
      const std::string all = (name.empty() ? "" : name + part) + suffix;
      return name.empty() && !suffix.empty() ? all.substr(1) : all;
    }
  };

  void read(const Json& object, const std::string& where, const Feature& feature, int depth = 0) {
    where_ = where;
    constexpr int kMostDepth = 3;  // a collection of features, of geometries in collections
    if (depth > kMostDepth) refuse("{}: collections that stand in each other", where);
    if (!object.is_object() || !object.contains("type")) refuse("{}: expected an object with a type", where);
    const std::string type = object.at("type");
    int n = 0;
    if (type == "FeatureCollection") {
      for (const Json& one : object.at("features"))
        read(one, fmt::format("{}: feature {}", where, ++n), {}, depth + 1);
    } else if (type == "GeometryCollection") {
      for (const Json& geometry : object.at("geometries")) read(geometry, where, feature, depth + 1);
    } else if (type == "Feature") {
      const Feature own = feature_of(object, where);
      if (!object.at("geometry").is_null())
        read(object["geometry"], own.name.empty() ? where : where + " ('" + own.name + "')", own, depth + 1);
    } else if (type == "Polygon") {
      add_polygon(object.at("coordinates"), where, feature);
    } else if (type == "MultiPolygon") {
      for (const Json& polygon : object.at("coordinates"))
        add_polygon(polygon, fmt::format("{}, polygon {}", where, ++n), feature);
    } else if (type == "LineString") {
      add_line(object.at("coordinates"), where, feature);
    } else if (type == "MultiLineString") {
      for (const Json& line : object.at("coordinates"))
        add_line(line, fmt::format("{}, line {}", where, ++n), feature);
    } else if (type == "MultiPoint") {
      for (const Json& at : object.at("coordinates"))
        model_.points.push_back({point(at, where), feature.name, where});
    } else if (type == "Point") {
      model_.points.push_back({point(object.at("coordinates"), where), feature.name, where});
    } else {
      refuse("{}: the type '{}' is not known: expected polygons, lines and points", where, type);
    }
  }

  Feature feature_of(const Json& object, const std::string& where) {
    static const std::vector<std::string> kKnown = {"barrier", "crack", "boundary", "weir"};
    Feature feature;
    const auto properties = object.find("properties");
    if (properties == object.end() || !properties->is_object()) return feature;
    for (const char* key : {"NAME", "ID"})
      for (const auto& [property, name] : properties->items())
        if (feature.name.empty() && upper(property) == key && !name.is_null())
          feature.name = name.is_string() ? name.get<std::string>() : name.dump();
    for (const auto& [property, value] : properties->items()) {
      const bool is_flag = value.is_boolean();
      if (property == "barrier" || property == "crack") {
        if (is_flag) feature.is_barrier |= value.get<bool>();
        if (!is_flag) note(where, property, value, ": expected true or false");
      } else if (property == "weir") {
        if (is_flag || value.is_number())
          feature.suffix += is_flag ? value.get<bool>() ? "_weir" : "" : "_weir_" + value.dump();
        else
          note(where, property, value, ": expected true, or the height of its crest");
      } else if (property == "boundary") {
        if (value == "open" && !name_contains(feature.name, "open")) feature.suffix += "_open";
        if (value == "land" && name_contains(feature.name, "open"))
          note(where, property, value, ", but the name says open: rename it");
        if (value != "open" && value != "land") note(where, property, value, ": expected open or land");
      } else if (const std::string near = suggestion(property, kKnown); !near.empty()) {
        note(where, property, value, near);
      }
    }
    return feature;
  }

  /// Once for each value of a property.
  void note(const std::string& where, const std::string& property, const Json& value,
            const std::string& why) {
    if (const std::string text = fmt::format("the property '{}' is {}{}", property, value.dump(), why);
        noted_.insert(text).second)
      model_.notes.push_back(where + ": " + text);
  }

  Vec2 point(const Json& xy, const std::string& where) {
    where_ = where;
    const Vec2 p{xy.at(0), xy.at(1)};
    if (constexpr double kMost = 1e60; !(norm(p) < kMost))  // else their squares overflow
      refuse("{}: a point at {}: expected coordinates below {:g}", where, show_point(p), kMost);
    are_degrees_ = are_degrees_ && std::abs(p.x) <= 180 && std::abs(p.y) <= 90;
    return p;
  }

  int add_curve(const Json& line, const std::string& where, const std::string& name) {
    std::vector<Vec2> points;
    for (const Json& xy : line) {
      const Vec2 p = point(xy, where);
      if (points.empty() || p != points.back()) points.push_back(p);  // twice the same: common in such files
    }
    model_.curves.push_back({located(where, [&] { return make_polyline(points); }), name, where});
    model_.curves.back().is_data = true;
    return static_cast<int>(model_.curves.size()) - 1;
  }

  void add_line(const Json& line, const std::string& where, const Feature& feature) {
    const std::string name = feature.curve("");
    const int curve = add_curve(line, where, name.empty() && feature.is_barrier ? "barrier" : name);
    model_.curves[curve].is_crack = feature.is_barrier;
  }

  void add_polygon(const Json& rings, const std::string& where, const Feature& feature) {
    int n = 0;
    for (const Json& ring : rings) {
      const std::string place = rings.size() == 1 ? where : fmt::format("{}, ring {}", where, n + 1);
      if (ring.size() < 4) refuse("{}: a ring of {} points: expected four or more", place, ring.size());
      if (ring.front() != ring.back())
        refuse(
            "{}: the ring is open: it ends at {} and begins at {}; end it with its first point "
            "[open-outline]",
            place, ring.back().dump(), ring.front().dump());
      const std::string part = n == 0 ? "_outline" : fmt::format("_hole_{}", n);
      const int curve = add_curve(ring, place, feature.curve(part));
      model_.loops.push_back({{curve}, n == 0 ? feature.name : "", place, n > 0});
      ++n;
    }
  }

  void check_unit(const Json& root, const Outlines& file) {
    crs_ = file.crs;
    if (const auto at = root.find("crs"); crs_.empty() && at != root.end() && at->is_object())
      crs_ = at->at("properties").at("name");
    if (file.in_degrees || crs_.ends_with("CRS84") || crs_.ends_with(":4326") ||
        (crs_.empty() && are_degrees_))
      refuse(
          "{0}: the coordinates are degrees of longitude and latitude: expected lengths. Write {0}@utm or "
          "{0}@EPSG:CODE to convert them. If they are lengths, name another coordinate system in the file "
          "(GeoJSON: \"crs\") [degrees-as-lengths]",
          path_);
  }

  std::string path_, where_, crs_;
  PlanarModel model_;
  std::set<std::string> noted_;
  bool are_degrees_ = true;
};

}  // namespace

PlanarModel read_geojson(const std::filesystem::path& path) {
  return GeoJsonReader(path, {std::string(read_whole_file(path))}).model();
}

Model read_outlines(const OutlineFile& file, std::string& crs, std::string& unit) {
  const std::string kind = kind_of_file(file.path);
  const bool as_it_is = file.layer.empty() && file.project.empty();
  if (kind == kDxf && !as_it_is)
    refuse("{}: a drawing is read with all its layers, and is not projected", file.path.string());
  if (kind == kDxf) return read_dxf(file.path, unit);
  GeoJsonReader reader(file.path, kind == kGeoJson && as_it_is
                                      ? Outlines{std::string(read_whole_file(file.path))}
                                      : read_layer(file.path, file.layer, file.project));
  crs = reader.crs();
  return reader.model();
}

std::optional<OutlineFile> outline_file_of(const std::filesystem::path& name) {
  const std::string text = name.string();
  for (std::size_t at = 0; at < text.size(); ++at) {
    at = std::min(text.find_first_of(":@", at), text.size());
    const std::string path = text.substr(0, at), rest = text.substr(at);
    if (kKinds.count(kind_of_file(path)) == 0) continue;
    const std::size_t crs = std::min(rest.find('@'), rest.size());
    return OutlineFile{path, crs > 0 ? rest.substr(1, crs - 1) : "",
                       crs < rest.size() ? rest.substr(crs + 1) : ""};
  }
  return std::nullopt;
}

std::string outline_files() { return fmt::format("{}", fmt::join(kKinds, ", ")); }

std::vector<Vec2> read_points(const std::filesystem::path& path) {
  TextScanner in(path);
  const std::string_view text = in.text();
  const std::string_view first = text.substr(0, text.find('\n'));
  if (first.find_first_of("ABCDFGHIJKLMNOPQRSTUVWXYZabcdfghijklmnopqrstuvwxyz#") != std::string_view::npos)
    in.rest_of_line();  // a name
  std::vector<Vec2> points;
  while (!in.at_end()) {
    if (in.next_is('#')) {
      in.rest_of_line();
      continue;
    }
    const double x = in.real("x"), y = in.real("y");
    if (!in.at_end_of_line() && !in.next_is('#'))
      in.fail("more than two coordinates on a line: expected x and y");
    points.push_back({x, y});
  }
  // Two counts, then both sides from the nose: round the profile from the trailing edge of the upper one.
  if (points.size() > 4 && points[0].x >= 2 && points[0].y >= 2 &&
      points[0].x + points[0].y == static_cast<double>(points.size() - 1)) {
    const auto n = static_cast<std::ptrdiff_t>(points[0].x);
    points.erase(points.begin());
    std::reverse(points.begin(), points.begin() + n);
    if (points[n - 1] == points[n]) points.erase(points.begin() + n);
  }
  if (points.size() < 2) refuse("{}: expected two points or more", path.string());
  return points;
}

}  // namespace delquad
