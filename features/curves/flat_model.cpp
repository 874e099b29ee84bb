// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/curves/flat_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "base/box_tree.h"
#include "base/sort_unique.h"
#include "delquad/error.h"
#include "features/curves/mesh_planar_curves.h"
#include "geometry/mesh/constrained_delaunay.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/nearest_triangle.h"
#include "geometry/planar/curve_span.h"
#include "geometry/planar/loops_apart.h"
#include "geometry/planar/model_chain.h"
#include "geometry/surface/curve_chains.h"

namespace delquad {
namespace {

/// Where a planar curve turns by more, its point counts as a corner.
constexpr double kTurn = 30 * std::numbers::pi / 180;

}  // namespace

SurfaceModel flat_model(const PlanarDomain& domain, const std::string& source) {
  SurfaceModel model;
  model.source = source;
  model.fine = domain.boundary;
  for (std::size_t p = 0; p < domain.patches.size(); ++p) {
    const auto& node = domain.patches[p].point_node;
    for (const auto& [a, b, c] : constrained_delaunay(domain.patches[p]).triangles) {
      if (node[a] == node[b] || node[b] == node[c] || node[c] == node[a]) continue;  // at openings
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

namespace {

/// The faces and curves of a flat surface.
class FlatGeometry final : public SurfaceProjector {
 public:
  /// `piece_curves` has the curve of the domain on which each piece lies (-1: none), `of` the same for each
  /// curve.
  FlatGeometry(std::vector<DomainPiece> pieces, const std::vector<int>& piece_curves, std::vector<int> of)
      : pieces_(std::move(pieces)), of_(std::move(of)), spans_(*std::ranges::max_element(of_) + 1) {
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      if (const int curve = piece_curves[i]; curve >= 0)
        spans_[curve].push_back({{*pieces_[i].shape, pieces_[i].from, pieces_[i].to}, &pieces_[i]});
    for (const auto& spans : spans_) {
      std::vector<Box<Vec2>> boxes;
      for (const PieceSpan& s : spans) boxes.push_back(s.span.box());
      trees_.emplace_back(boxes);
    }
  }
  Vec3 to_face(int, const Vec3& x) const override { return {x.x, x.y, 0}; }
  Vec3 to_curve(int curve, const Vec3& x) const override {
    CurveSpan::Place best{0, {x.x, x.y}, std::numeric_limits<double>::infinity()};
    const DomainPiece* piece = nullptr;
    double best2 = std::numeric_limits<double>::infinity();
    trees_[of_[curve]].nearest(Vec2{x.x, x.y}, best2, [&](int i) {
      const auto& [span, of] = spans_[of_[curve]][i];
      const CurveSpan::Place place = span.nearest({x.x, x.y});
      if (!(place.distance < best.distance)) return;
      best = place, piece = of, best2 = place.distance * place.distance;
    });
    const Vec2 at = piece != nullptr ? improved(*piece, best, {x.x, x.y}) : best.at;
    return {at.x, at.y, 0};
  }
  PrincipalCurvatures curvatures(int, const Vec3&) const override { return {0, 0, {1, 0, 0}}; }

 private:
  /// Returns the nearest place to rounding: distances alone tell it to half of the digits.
  static Vec2 improved(const DomainPiece& piece, const CurveSpan::Place& place, Vec2 x) {
    constexpr double kStep = 1e-5, kAsNear = 1 + 1e-9;
    constexpr int kSteps = 2;
    const auto [low, high] = std::minmax(piece.from, piece.to);
    double t = place.t;
    for (int step = 0; step < kSteps; ++step) {
      const double a = std::max(t - kStep * (high - low), low), b = std::min(t + kStep * (high - low), high);
      const Vec2 along = (1 / (b - a)) * (piece.shape->point(b) - piece.shape->point(a));
      t = std::clamp(t + dot(x - piece.shape->point(t), along) / dot(along, along), low, high);
    }
    const Vec2 at = piece.shape->point(t);
    return norm(at - x) <= kAsNear * place.distance ? at : place.at;
  }

  struct PieceSpan {
    CurveSpan span;
    const DomainPiece* piece;
  };

  std::vector<DomainPiece> pieces_;  ///< keep their shapes
  std::vector<int> of_;
  std::vector<std::vector<PieceSpan>> spans_;
  std::vector<BoxTree<Vec2>> trees_;  ///< boxes of the spans of each curve
};

/// Takes the points that lie on no curve out of a model, as lines of one point.
std::vector<LooseLine> take_single_points(PlanarModel& model) {
  const ModelChain chain = chain_model(model);
  std::vector<char> on_curve(chain.nodes.size(), 0);
  for (const auto& ends : chain.curve_ends)
    for (const int v : ends) on_curve[v] = 1;
  for (const auto& stops : chain.stops)
    for (const CurveStop& stop : stops) on_curve[stop.node] = 1;
  std::vector<LooseLine> loose;
  std::vector<ModelPoint> kept;
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    ModelPoint& point = model.points[i];
    if (on_curve[chain.point_nodes[i]]) {
      kept.push_back(std::move(point));
      continue;
    }
    LooseLine& line = loose.emplace_back();
    line.points = {{point.at.x, point.at.y, 0}};
    if (!point.name.empty()) line.names = {point.name};
    line.where = model.source + (model.source.empty() ? "" : ": ") + point_label(model, static_cast<int>(i));
    line.is_requested = true;
  }
  model.points = std::move(kept);
  return loose;
}

/// Throws InputError for single points outside of all regions.
void check_inside(const std::vector<LooseLine>& loose, const Mesh& mesh) {
  if (loose.empty()) return;
  const NearestTriangle regions(mesh.points, mesh.triangles);
  for (const LooseLine& point : loose)
    if (const Vec3& x = point.points[0]; regions.find(x).distance > kTouch * diagonal(mesh))
      throw InputError(fmt::format("{} at ({:.10g}, {:.10g}) lies outside of every region [embedded-outside]",
                                   point.where, x.x, x.y));
}

/// Lists the lines of a domain along its curves, of which each part in one chain becomes a curve. Corners are
/// the ends of pieces and named points. Returns the curves of the domain on which pieces and new curves lie;
/// -1: none.
std::pair<std::vector<int>, std::vector<int>> lines_of_pieces(const PlanarDomain& domain,
                                                              SurfaceModel& model) {
  Mesh& mesh = model.fine;
  std::map<std::pair<int, int>, int> curve_at;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
    curve_at[std::minmax(mesh.lines[l][0], mesh.lines[l][1])] = mesh.line_curve[l];
  std::vector<int> of_piece, of_curve, corners;
  for (const NamedPoint& point : mesh.named_points) corners.push_back(point.point);
  mesh.lines.clear();
  mesh.line_curve.clear();
  for (const DomainPiece& piece : domain.pieces) {
    std::vector<int> nodes{piece.ends[0]};
    nodes.insert(nodes.end(), piece.nodes.begin(), piece.nodes.end());
    nodes.push_back(piece.ends[1]);
    const auto line = curve_at.find(std::minmax(nodes[0], nodes[1]));
    of_piece.push_back(line == curve_at.end() ? -1 : line->second);
    if (of_piece.back() < 0) continue;
    corners.insert(corners.end(), piece.ends.begin(), piece.ends.end());
    const bool goes_on =
        !of_curve.empty() && of_curve.back() == of_piece.back() && mesh.lines.back()[1] == nodes[0];
    if (!goes_on) of_curve.push_back(of_piece.back());
    for (std::size_t k = 1; k < nodes.size(); ++k) {
      mesh.lines.push_back({nodes[k - 1], nodes[k]});
      mesh.line_curve.push_back(static_cast<int>(of_curve.size()) - 1);
    }
  }
  sort_unique(corners);
  model.corners = std::move(corners);
  mesh.curves = entities_of_pieces(mesh.curves, of_curve);
  return {std::move(of_piece), std::move(of_curve)};
}

}  // namespace

SurfaceModel flat_surface(const PlanarModel& given, const SizeField& size) {
  PlanarModel plain = given;
  std::vector<LooseLine> loose = take_single_points(plain);
  for (ModelCurve& curve : plain.curves) curve.is_crack = false;
  const PlanarDomain domain = chord_domain(plain, size);
  SurfaceModel model = flat_model(domain, given.source);
  Mesh& mesh = model.fine;
  check_inside(loose, mesh);
  model.loose = std::move(loose);
  const auto [piece_curves, of_curve] = lines_of_pieces(domain, model);
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  std::set<std::pair<int, int>> known;  // curves in faces
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    const int curve = mesh.line_curve[l];
    const auto beside = sides_of_edge(sides, mesh.lines[l][0], mesh.lines[l][1]);
    if (beside.size() != 2) continue;
    const int face = region_of(mesh, beside[0].element);
    const bool is_inside = region_of(mesh, beside[1].element) == face;
    if (is_inside && !known.insert({curve, face}).second) continue;
    const auto& of_model = domain.model_curves[of_curve[curve]];
    const auto crack = std::ranges::find_if(of_model, [&](int c) { return given.curves[c].is_crack; });
    const bool is_crack = crack != of_model.end();
    if (is_crack && !is_inside)
      throw InputError(fmt::format(
          "{}: a crack between two regions does not go with symmetry: expected one region around it",
          curve_label(given, *crack)));
    if (!is_inside) continue;
    model.embedded.push_back({curve, face, false, is_crack});
  }
  model.projector = std::make_shared<FlatGeometry>(domain.pieces, piece_curves, of_curve);
  return model;
}

}  // namespace delquad
