#include "program/info_record.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/box.h"
#include "base/warning.h"
#include "geometry/surface/model_report.h"

namespace delquad {

namespace {

using Json = nlohmann::ordered_json;

/// Degrees below which a corner is listed: no quad in it gets an eta above 1/3.
constexpr double kListedAngle = 30;

Json point_json(const Vec3& p) { return {p.x, p.y, p.z}; }

Json tags(const std::vector<Entity>& entities, const std::vector<int>& indices) {
  Json json = Json::array();
  for (const int i : indices) json.push_back(entities[i].tag);
  return json;
}

Json face_json(const ModelInfo& info, std::size_t f, const std::array<Vec3, 2>& box) {
  const FaceReport& face = info.report.faces[f];
  const Mesh& mesh = info.fine;
  return {{"tag", mesh.regions[f].tag},
          {"names", mesh.regions[f].names},
          {"area", face.area},
          {"box", {point_json(box[0]), point_json(box[1])}},
          {"topology", topology(face)},
          {"loops", face.loops},
          {"handles", face.handles},
          {"pieces", face.pieces},
          {"width", std::isfinite(face.width) ? Json(face.width) : Json()},
          {"curves", tags(mesh.curves, face.curves)}};
}

Json curve_json(const ModelInfo& info, std::size_t c) {
  const CurveReport& curve = info.report.curves[c];
  const Mesh& mesh = info.fine;
  const std::size_t n = curve.faces.size();
  return {{"tag", mesh.curves[c].tag},
          {"names", mesh.curves[c].names},
          {"length", curve.length},
          {"closed", curve.closed},
          {"kind", n < 2    ? "free"
                   : n == 2 ? "inner"
                            : "branching"},
          {"faces", tags(mesh.regions, curve.faces)}};
}

Json corner_json(const ModelInfo& info, const CornerReport& corner) {
  const Mesh& mesh = info.fine;
  return {{"face", mesh.regions[corner.face].tag},
          {"curves", {mesh.curves[corner.curves[0]].tag, mesh.curves[corner.curves[1]].tag}},
          {"at", point_json(corner.at)},
          {"angle", corner.angle}};
}

}  // namespace

SmallFeatures smaller_than(const ModelReport& report, double size) {
  SmallFeatures small;
  for (std::size_t c = 0; c < report.curves.size(); ++c)
    if (report.curves[c].length < size) small.curves.push_back(static_cast<int>(c));
  for (std::size_t f = 0; f < report.faces.size(); ++f)
    if (report.faces[f].width < size) small.faces.push_back(static_cast<int>(f));
  return small;
}

std::vector<CornerReport> sharp_corners(const ModelReport& report) {
  std::vector<CornerReport> sharp;
  for (const CornerReport& corner : report.corners)
    if (corner.angle < kListedAngle) sharp.push_back(corner);
  std::ranges::stable_sort(sharp, {}, &CornerReport::angle);
  return sharp;
}

std::vector<std::array<Vec3, 2>> boxes_of_faces(const Mesh& mesh) {
  std::vector<std::vector<Vec3>> corners(mesh.regions.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const int v : mesh.triangles[t]) corners[mesh.triangle_region[t]].push_back(mesh.points[v]);
  std::vector<std::array<Vec3, 2>> boxes;
  for (const std::vector<Vec3>& points : corners) {
    if (points.empty()) {
      boxes.push_back({});  // a face that was left out
      continue;
    }
    const Box<Vec3> box = Box<Vec3>::around(points);
    boxes.push_back({box.low, box.high});
  }
  return boxes;
}

std::string info_record(const ModelInfo& info, double size) {
  const ModelReport& report = info.report;
  const Mesh& mesh = info.fine;
  Json json = {{"model", info.source},
               {"unit", mesh.unit.empty() ? Json() : Json(mesh.unit)},
               {"box", {point_json(report.low), point_json(report.high)}},
               {"diagonal", report.diagonal},
               {"area", report.area},
               {"free_length", report.free_length},
               {"vertices", report.vertices},
               {"fine_triangles", mesh.triangles.size()}};
  json["shells"] = Json::array();
  for (const ShellReport& shell : report.shells)
    json["shells"].push_back({{"faces", tags(mesh.regions, shell.faces)},
                              {"area", shell.area},
                              {"closed", shell.closed},
                              {"euler_characteristic", shell.euler_characteristic}});
  json["faces"] = Json::array();
  const auto boxes = boxes_of_faces(mesh);
  for (std::size_t f = 0; f < report.faces.size(); ++f) json["faces"].push_back(face_json(info, f, boxes[f]));
  json["curves"] = Json::array();
  for (std::size_t c = 0; c < report.curves.size(); ++c) json["curves"].push_back(curve_json(info, c));
  json["sharp_corners"] = Json::array();
  for (const CornerReport& corner : sharp_corners(report))
    json["sharp_corners"].push_back(corner_json(info, corner));
  if (size > 0) {
    const SmallFeatures small = smaller_than(report, size);
    json["size"] = size;
    json["smaller_than_size"] = {{"curves", tags(mesh.curves, small.curves)},
                                 {"faces", tags(mesh.regions, small.faces)}};
  }
  json["warnings"] = texts(info.warnings);
  // A name need not be UTF-8; JSON must be.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace delquad
