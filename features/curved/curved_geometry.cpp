#include "features/curved/curved_geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "base/segment.h"
#include "geometry/mesh/nearest_triangle.h"
#include "geometry/planar/curve_search.h"

namespace delquad {
namespace {

Vec3 straight_point(const Mesh& mesh, int line, double part) {
  const auto [a, b] = mesh.lines[line];
  return (1 - part) * mesh.points[a] + part * mesh.points[b];
}

/// Vertices by where they are: meshes number them in their own ways.
using PlaceSet = std::set<std::array<double, 3>>;
std::array<double, 3> place_of(const Vec3& x) { return {x.x, x.y, x.z}; }

/// Curves of the plane.
class PlanarGeometry final : public ModelGeometry {
 public:
  PlanarGeometry(const PreparedProblem& prepared, const SurfaceNodes& nodes, const Mesh& mesh)
      : mesh_(mesh), tolerance_(kOnCurve * diagonal(mesh)) {
    for (std::size_t i = 0; i < prepared.plane.curve_places.size(); ++i)
      if (prepared.plane.curve_places[i].curve) sliding_.insert(place_of(nodes.points[i]));
    std::map<const Curve*, int> known;
    std::vector<std::shared_ptr<const Curve>> curves;
    std::vector<int> edges;
    for (const auto& shapes : prepared.plane.curve_shapes) {
      std::vector<int>& of_curve = searches_of_.emplace_back();
      for (const auto& shape : shapes) {
        const auto [at, is_new] = known.try_emplace(shape.get(), static_cast<int>(curves.size()));
        if (is_new) curves.push_back(shape), edges.push_back(0);
        of_curve.push_back(at->second);
      }
    }
    for (const int c : mesh.line_curve)
      if (c < static_cast<int>(searches_of_.size()))
        for (const int s : searches_of_[c]) ++edges[s];
    for (std::size_t i = 0; i < curves.size(); ++i) searches_.emplace_back(curves[i], edges[i]);
  }

  std::vector<Vec3> on_line(int line, std::span<const double> parts) const override {
    const auto [a, b] = mesh_.lines[line];
    const Vec3 &p = mesh_.points[a], &q = mesh_.points[b];
    const CurveSearch* best = nullptr;
    CurveSearch::Span span{0, 0, tolerance_};
    const auto c = static_cast<std::size_t>(mesh_.line_curve[line]);
    if (c < searches_of_.size())
      for (const int s : searches_of_[c]) {
        const CurveSearch::Span other = searches_[s].between({p.x, p.y}, {q.x, q.y});
        if (other.off < span.off) span = other, best = &searches_[s];
      }
    std::vector<Vec3> points;
    if (best == nullptr) {
      for (const double part : parts) points.push_back(straight_point(mesh_, line, part));
    } else {
      for (const Vec2& x : best->at_parts(span, parts)) points.push_back({x.x, x.y, p.z});
    }
    return points;
  }
  std::optional<Vec3> on_curve(int curve, const Vec3& x) const override {
    std::optional<Vec3> best;
    double least = std::numeric_limits<double>::infinity();
    if (static_cast<std::size_t>(curve) >= searches_of_.size()) return best;
    for (const int s : searches_of_[curve])
      if (const CurveSearch::Found found = searches_[s].nearest({x.x, x.y}); found.distance < least) {
        const Vec2 at = searches_[s].point(found.t);
        least = found.distance, best = Vec3{at.x, at.y, x.z};
      }
    return best;
  }
  bool slides(int vertex) const override { return sliding_.contains(place_of(mesh_.points[vertex])); }
  Vec3 on_face(int, const Vec3& x) const override { return x; }

 private:
  /// Ends of lines are no further from their curve, in diagonals.
  static constexpr double kOnCurve = 1e-6;

  const Mesh& mesh_;
  double tolerance_;
  std::vector<std::vector<int>> searches_of_;  ///< by curve of the mesh
  std::vector<CurveSearch> searches_;
  PlaceSet sliding_;
};

/// Faces and curves of space.
class SurfaceGeometry final : public ModelGeometry {
 public:
  SurfaceGeometry(const PreparedSurface& surface, const SurfaceNodes& nodes, const Mesh& mesh)
      : surface_(surface), mesh_(mesh) {
    const SurfaceDomain& domain = surface.domain;
    for (std::size_t c = 0; c < domain.chains.size(); ++c) {
      chains_of_[domain.chains[c].curve].push_back(static_cast<int>(c));
      for (std::size_t k = 1; k + 1 < nodes.on_curve[c].size(); ++k)
        if (!domain.chain_stays[c]) sliding_.insert(place_of(nodes.points[nodes.on_curve[c][k].node]));
      for (std::size_t k = 0; k + 1 < nodes.on_curve[c].size(); ++k) {
        const CurveNode &a = nodes.on_curve[c][k], &b = nodes.on_curve[c][k + 1];
        spans_.emplace(key(domain.chains[c].curve, nodes.points[a.node], nodes.points[b.node]),
                       Span{static_cast<int>(c), a.s, b.s});
        spans_.emplace(key(domain.chains[c].curve, nodes.points[b.node], nodes.points[a.node]),
                       Span{static_cast<int>(c), b.s, a.s});
      }
    }
    if (surface.model.projector) return;
    const Mesh& fine = surface.model.fine;
    std::vector<std::vector<std::array<int, 3>>> of_face(fine.regions.size());
    for (std::size_t t = 0; t < fine.triangles.size(); ++t)
      of_face[fine.triangle_region[t]].push_back(fine.triangles[t]);
    for (auto& triangles : of_face)
      faces_.push_back(
          triangles.empty() ? nullptr : std::make_unique<NearestTriangle>(fine.points, std::move(triangles)));
  }

  std::vector<Vec3> on_line(int line, std::span<const double> parts) const override {
    const auto [a, b] = mesh_.lines[line];
    const auto found = spans_.find(key(mesh_.line_curve[line], mesh_.points[a], mesh_.points[b]));
    std::vector<Vec3> points;
    for (const double part : parts)
      points.push_back(found == spans_.end() ? straight_point(mesh_, line, part)
                                             : on_span(found->second, part));
    return points;
  }
  std::optional<Vec3> on_curve(int curve, const Vec3& x) const override {
    const auto found = chains_of_.find(curve);
    if (found == chains_of_.end()) return std::nullopt;
    if (const auto& projector = surface_.model.projector) {
      const int face = surface_.domain.cut_face[curve];
      return face >= 0 ? projector->to_face(face, x) : projector->to_curve(curve, x);
    }
    const std::vector<Vec3>& p = surface_.model.fine.points;
    Vec3 best = p[surface_.domain.chains[found->second.front()].points.front()];
    for (const int c : found->second) {
      const std::vector<int>& chain = surface_.domain.chains[c].points;
      for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
        const Vec3 at = nearest_on_segment(x, p[chain[i]], p[chain[i + 1]]);
        if (norm(at - x) < norm(best - x)) best = at;
      }
    }
    return best;
  }
  bool slides(int vertex) const override { return sliding_.contains(place_of(mesh_.points[vertex])); }
  Vec3 on_face(int region, const Vec3& x) const override {
    if (surface_.model.projector) return surface_.model.projector->to_face(region, x);
    if (!faces_[region]) return x;
    const NearestTriangle::Found found = faces_[region]->find(x);
    const auto& v = faces_[region]->triangle(found.triangle);
    const std::vector<Vec3>& p = surface_.model.fine.points;
    return found.weights[0] * p[v[0]] + found.weights[1] * p[v[1]] + found.weights[2] * p[v[2]];
  }

 private:
  /// A curve and two places: nodes are told by these, for meshes number them in their own ways.
  using Key = std::tuple<int, double, double, double, double, double, double>;
  static Key key(int curve, const Vec3& a, const Vec3& b) { return {curve, a.x, a.y, a.z, b.x, b.y, b.z}; }
  /// Between two places on a chain, see CurveNode.
  struct Span {
    int chain;
    double from, to;
  };

  /// By length along the fine lines, then on the true curve.
  Vec3 on_span(const Span& span, double part) const {
    const SurfaceDomain& domain = surface_.domain;
    const CurveChain& chain = domain.chains[span.chain];
    const auto at = [&](double s) { return fine_point_at(surface_.model.fine, chain, s); };
    const auto [low, high] = std::minmax(span.from, span.to);
    std::vector<double> s{low};
    for (double k = std::floor(low) + 1; k < high; ++k) s.push_back(k);
    s.push_back(high);
    std::vector<double> length{0};
    for (std::size_t i = 1; i < s.size(); ++i)
      length.push_back(length.back() + norm(at(s[i]) - at(s[i - 1])));
    const double wanted = (span.from < span.to ? part : 1 - part) * length.back();
    const auto after = std::upper_bound(length.begin() + 1, length.end() - 1, wanted);
    const auto i = static_cast<std::size_t>(after - length.begin());
    const double step = length[i] - length[i - 1];
    const double t = step > 0 ? (wanted - length[i - 1]) / step : 0.5;
    return place_on_curve(surface_.model, chain, domain.cut_face, s[i - 1] + t * (s[i] - s[i - 1]));
  }

  const PreparedSurface& surface_;
  const Mesh& mesh_;
  std::map<Key, Span> spans_;
  std::map<int, std::vector<int>> chains_of_;  ///< of each curve
  PlaceSet sliding_;
  std::vector<std::unique_ptr<NearestTriangle>> faces_;  ///< of a triangulation, by face
};

}  // namespace

std::unique_ptr<ModelGeometry> geometry_behind(const PreparedProblem& prepared, const SurfaceNodes& nodes,
                                               const Mesh& mesh) {
  if (prepared.surface) return std::make_unique<SurfaceGeometry>(*prepared.surface, nodes, mesh);
  return std::make_unique<PlanarGeometry>(prepared, nodes, mesh);
}

}  // namespace delquad
