#include "cases/model_info.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/activity.h"
#include "base/box.h"
#include "base/box_tree.h"
#include "cases/problem.h"
#include "curves/mesh_planar_curves.h"
#include "delquad/error.h"
#include "features/given/given_domain.h"
#include "features/given/given_surface.h"
#include "features/given/named_domain.h"
#include "geometry/mesh/constrained_delaunay.h"
#include "geometry/surface/curve_chains.h"
#include "mesher/surface_input.h"

namespace delquad {

namespace {

using Json = nlohmann::ordered_json;

/// Edges of planar curves, in diagonals of the model.
constexpr double kPlanarEdge = 1.0 / 2000;
/// Where a planar curve turns by more, its point counts as a corner.
constexpr double kTurn = 30 * std::numbers::pi / 180;
/// Degrees below which a corner is listed: no quad in it gets an eta above 1/3.
constexpr double kListedAngle = 30;

double diagonal_of(const PlanarModel& model) {
  constexpr int kPoints = 200;  // a curve
  Box<Vec2> box = Box<Vec2>::around({model.curves.at(0).shape->point(0)});
  for (const ModelCurve& curve : model.curves)
    for (int k = 0; k <= kPoints; ++k) {
      const Vec2 p = curve.shape->point(double(k) / kPoints);
      box.add(p);
    }
  return norm(box.size());
}

/// The regions of a domain, triangulated between the points of their boundary.
SurfaceModel as_model(const PlanarDomain& domain, const std::string& source) {
  SurfaceModel model;
  model.source = source;
  model.fine = domain.boundary;
  for (std::size_t p = 0; p < domain.patches.size(); ++p) {
    const auto& node = domain.patches[p].point_node;
    for (const auto& [a, b, c] : constrained_delaunay(domain.patches[p]).triangles) {
      model.fine.triangles.push_back({node[a], node[b], node[c]});
      model.fine.triangle_region.push_back(domain.patch_region[p]);
    }
  }
  const Mesh& mesh = model.fine;
  std::vector<char> corner(mesh.points.size(), 0);
  mark_turns(mesh, kTurn, std::vector<char>(mesh.points.size(), 1), corner);
  std::vector<int> curve_at(mesh.points.size(), -1);
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
    for (const int v : mesh.lines[l]) {
      if (curve_at[v] >= 0 && curve_at[v] != mesh.line_curve[l]) corner[v] = 1;
      curve_at[v] = mesh.line_curve[l];
    }
  for (std::size_t v = 0; v < corner.size(); ++v)
    if (corner[v]) model.corners.push_back(static_cast<int>(v));
  return model;
}

SurfaceModel load(const MeshProblem& problem) {
  const DoingStage stage("reading");
  if (const auto* model = std::get_if<PlanarModel>(&problem.model)) {
    const double edge = kPlanarEdge * diagonal_of(*model);
    return as_model(make_domain(*model, [edge](const Vec3&) { return edge; }), model->source);
  }
  if (const auto* lines = std::get_if<LineModel>(&problem.model))
    return as_model(make_named_domain(lines->mesh, lines->surfaces, lines->source), lines->source);
  if (const auto* given = std::get_if<GivenMesh>(&problem.model)) {
    if (!is_in_space(given->mesh)) return as_model(make_given_domain(*given).domain, given->source);
    return make_given_surface(*given, problem.surface.feature_angle.value_or(kGivenFeatureAngle)).model;
  }
  return make_surface(problem);
}

Json point_json(const Vec3& p) { return {p.x, p.y, p.z}; }

Json tags(const std::vector<Entity>& entities, const std::vector<int>& indices) {
  Json json = Json::array();
  for (const int i : indices) json.push_back(entities[i].tag);
  return json;
}

Json face_json(const ModelInfo& info, std::size_t f, const std::array<Vec3, 2>& box) {
  const FaceReport& face = info.report.faces[f];
  const Mesh& mesh = info.model.fine;
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
  const Mesh& mesh = info.model.fine;
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
  const Mesh& mesh = info.model.fine;
  return {{"face", mesh.regions[corner.face].tag},
          {"curves", {mesh.curves[corner.curves[0]].tag, mesh.curves[corner.curves[1]].tag}},
          {"at", point_json(corner.at)},
          {"angle", corner.angle}};
}

}  // namespace

ModelInfo model_info(const Case& c) {
  ModelInfo info;
  info.model = load(make_problem(c));
  info.report = report_model(info.model);
  return info;
}

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
  const Mesh& mesh = info.model.fine;
  Json json = {{"model", info.model.source},
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
  json["warnings"] = texts(info.model.warnings);
  // A name need not be UTF-8; JSON must be.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace delquad
