// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/curved/curved_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "base/box_tree.h"
#include "base/segment.h"
#include "base/sort_unique.h"
#include "delquad/model.h"
#include "features/symmetry/mirrored_surface.h"
#include "geometry/mesh/nearest_on_regions.h"

namespace delquad {
namespace {

/// Finds parameters of a curve: of points on it, and between them by length.
class CurveSearch {
 public:
  /// `edges`: about how many edges of a mesh lie on the curve.
  CurveSearch(std::shared_ptr<const Curve> curve, int edges);

  struct Found {
    double t, distance;
  };
  /// The parameter of the point next to x.
  Found nearest(Vec2 x) const;
  /// Returns the point at a parameter. A closed curve takes any parameter, another one the nearest in [0, 1].
  Vec2 point(double t) const;
  /// The part of the curve between two points of it; of a closed curve the shorter one.
  struct Span {
    double from, to;  ///< of a closed curve perhaps beyond [0, 1]
    double off;       ///< how far the points are from the curve, the greater distance
  };
  Span between(Vec2 a, Vec2 b) const;
  /// Points at these parts of the length of a span, which ascend.
  std::vector<Vec2> at_parts(const Span& span, std::span<const double> parts) const;

 private:
  std::shared_ptr<const Curve> curve_;
  std::vector<double> t_;  ///< of the samples, ascending
  std::vector<Vec2> samples_;
  BoxTree<Vec2> chords_;
  bool closed_;
};

constexpr int kSamplesOfCurve = 64, kSamplesOfEdge = 8;
/// A curve is closed whose ends are no further apart, in its extent: formulas of a full turn miss it by
/// rounding.
constexpr double kClosed = 1e-7;
/// Chords along which the length of a span is measured.
constexpr int kSpanChords = 64;
constexpr int kGoldenSteps = 60;

std::pair<double, double> nearest_on_chord(Vec2 a, Vec2 b, Vec2 x) {
  const double s = nearest_part(x, a, b);
  const Vec2 off = a + s * (b - a) - x;
  return {s, dot(off, off)};
}

CurveSearch::CurveSearch(std::shared_ptr<const Curve> curve, int edges) : curve_(std::move(curve)) {
  const int n = kSamplesOfCurve + kSamplesOfEdge * edges;
  for (int i = 0; i <= n; ++i) t_.push_back(static_cast<double>(i) / n);
  const std::vector<double> fixed = curve_->fixed_parameters();
  t_.insert(t_.end(), fixed.begin(), fixed.end());
  sort_unique(t_);
  for (const double t : t_) samples_.push_back(curve_->point(t));
  std::vector<Box<Vec2>> boxes;
  for (std::size_t i = 0; i + 1 < samples_.size(); ++i)
    boxes.push_back(Box<Vec2>::around({samples_[i], samples_[i + 1]}));
  chords_ = BoxTree<Vec2>(boxes);
  const auto box = Box<Vec2>::around(std::span<const Vec2>(samples_));
  closed_ = norm(samples_.back() - samples_.front()) <= kClosed * norm(box.high - box.low);
}

Vec2 CurveSearch::point(double t) const {
  if (closed_) t -= std::floor(t);
  return curve_->point(std::clamp(t, 0.0, 1.0));
}

CurveSearch::Found CurveSearch::nearest(Vec2 x) const {
  double best = std::numeric_limits<double>::infinity();
  int chord = 0;
  chords_.nearest(x, best, [&](int i) {
    const double d2 = nearest_on_chord(samples_[i], samples_[i + 1], x).second;
    if (d2 < best) best = d2, chord = i;
  });
  // Golden section; near the least the distance itself is too flat to tell places apart.
  const auto d2 = [&](double t) {
    const Vec2 d = point(t) - x;
    return dot(d, d);
  };
  const int last = static_cast<int>(t_.size()) - 1;
  double low = t_[std::max(chord - 1, 0)], high = t_[std::min(chord + 2, last)];
  constexpr double kGolden = 0.6180339887498949;
  double p = high - kGolden * (high - low), q = low + kGolden * (high - low);
  double at_p = d2(p), at_q = d2(q);
  for (int i = 0; i < kGoldenSteps; ++i) {
    if (at_p < at_q) {
      high = q, q = p, at_q = at_p;
      p = high - kGolden * (high - low), at_p = d2(p);
    } else {
      low = p, p = q, at_p = at_q;
      q = low + kGolden * (high - low), at_q = d2(q);
    }
  }
  Found found{(low + high) / 2, std::sqrt(d2((low + high) / 2))};
  for (const double t : {t_[chord], t_[chord + 1]})
    if (const double d = std::sqrt(d2(t)); d <= found.distance) found = {t, d};
  return found;
}

CurveSearch::Span CurveSearch::between(Vec2 a, Vec2 b) const {
  const Found from = nearest(a), to = nearest(b);
  Span span{from.t, to.t, std::max(from.distance, to.distance)};
  constexpr double kHalf = 0.5;
  if (closed_ && span.to - span.from > kHalf) span.to -= 1;
  if (closed_ && span.to - span.from < -kHalf) span.to += 1;
  return span;
}

std::vector<Vec2> CurveSearch::at_parts(const Span& span, std::span<const double> parts) const {
  std::vector<double> length{0};
  const auto t_of = [&](double s) { return span.from + s / kSpanChords * (span.to - span.from); };
  Vec2 before = point(span.from);
  for (int i = 1; i <= kSpanChords; ++i) {
    const Vec2 next = point(t_of(i));
    length.push_back(length.back() + norm(next - before));
    before = next;
  }
  std::vector<Vec2> points;
  for (const double part : parts) {
    const double wanted = part * length.back();
    const auto after = std::upper_bound(length.begin() + 1, length.end() - 1, wanted);
    const auto i = static_cast<double>(after - length.begin()) - 1;
    const double step = *after - *(after - 1);
    points.push_back(point(t_of(i + (step > 0 ? (wanted - *(after - 1)) / step : 0.5))));
  }
  return points;
}

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
  PlanarGeometry(const MeshingSetup& prepared, const SurfaceNodes& nodes, const Mesh& mesh)
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
  SurfaceGeometry(const SurfaceSetup& surface, const SurfaceNodes& nodes, const Mesh& mesh)
      : surface_(surface), mesh_(mesh), tolerance_(kOnPlane * diagonal(mesh)) {
    const int images = mirrored() != nullptr ? 1 << mirrored()->planes.count() : 1;
    for (std::size_t c = 0; c < surface.domain.chains.size(); ++c)
      for (int planes = 0; planes < images; ++planes) add_chain(static_cast<int>(c), planes, nodes);
    if (!surface.model.projector) facets_.emplace(surface.model.fine);
  }

  std::vector<Vec3> on_line(int line, std::span<const double> parts) const override {
    const auto [a, b] = mesh_.lines[line];
    const auto found = spans_.find(key(mesh_.line_curve[line], mesh_.points[a], mesh_.points[b]));
    std::vector<Vec3> points;
    for (const double part : parts)
      points.push_back(found == spans_.end() ? straight_point(mesh_, line, part)
                                             : image(found->second.planes, on_span(found->second, part)));
    return points;
  }
  std::optional<Vec3> on_curve(int curve, const Vec3& given) const override {
    const int planes = planes_before(given);
    const auto found = chains_of_.find({planes, curve});
    if (found == chains_of_.end()) return std::nullopt;
    return image(planes, on_planes(given, on_chains(found->second, image(planes, given))));
  }
  bool slides(int vertex) const override { return sliding_.contains(place_of(mesh_.points[vertex])); }
  Vec3 on_face(int region, const Vec3& given) const override {
    const int planes = planes_before(given);
    const int face = planes != 0 ? image_face(*mirrored(), planes, region) : region;
    const Vec3 x = image(planes, given);
    return image(planes, on_planes(given, facets_ ? facets_->place(face, x)
                                                  : surface_.model.projector->to_face(face, x)));
  }

 private:
  const MirroredSurface* mirrored() const { return surface_.mirrored.get(); }
  /// Returns the bits of the planes of symmetry behind which x lies.
  int planes_before(const Vec3& x) const {
    return mirrored() != nullptr ? mirrored()->planes.folds_of(x, tolerance_) : 0;
  }
  /// Returns x, on the planes of symmetry on which another place lies.
  Vec3 on_planes(const Vec3& other, const Vec3& x) const {
    int planes = 0;
    for (int k = 0; mirrored() != nullptr && k < mirrored()->planes.count(); ++k)
      planes |= (std::abs(mirrored()->planes.height(k, other)) <= tolerance_) << k;
    return planes != 0 ? mirrored()->planes.put_on_all(planes, x) : x;
  }
  Vec3 image(int planes, const Vec3& x) const {
    return planes != 0 ? mirrored()->planes.reflect_all(planes, x) : x;
  }

  /// Adds the image of a chain at planes of symmetry.
  void add_chain(int c, int planes, const SurfaceNodes& nodes) {
    const SurfaceDomain& domain = surface_.domain;
    const std::vector<CurveNode>& on_curve = nodes.on_curve[c];
    std::vector<int> curves{domain.chains[c].curve};
    if (mirrored() != nullptr) {
      const int whole = mirrored()->whole_curve[curves[0]];
      if (whole < 0) return;
      curves = image_curves(*mirrored(), planes, whole);
    }
    const auto at = [&](std::size_t k) {
      const int node = on_curve[k].node;
      return mirrored() != nullptr ? image_node(*mirrored(), planes, node, nodes.points[node])
                                   : nodes.points[node];
    };
    for (std::size_t k = 1; k + 1 < on_curve.size(); ++k)
      if (!domain.chain_stays[c]) sliding_.insert(place_of(at(k)));
    for (const int curve : curves) {
      chains_of_[{planes, curve}].push_back(c);
      for (std::size_t k = 0; k + 1 < on_curve.size(); ++k) {
        spans_.emplace(key(curve, at(k), at(k + 1)), Span{c, planes, on_curve[k].s, on_curve[k + 1].s});
        spans_.emplace(key(curve, at(k + 1), at(k)), Span{c, planes, on_curve[k + 1].s, on_curve[k].s});
      }
    }
  }

  /// Returns the nearest place of chains that are on one curve.
  Vec3 on_chains(const std::vector<int>& chains, const Vec3& x) const {
    const int curve = surface_.domain.chains[chains.front()].curve;
    if (const auto& projector = surface_.model.projector) {
      const int face = surface_.domain.cut_face[curve];
      return face >= 0 ? projector->to_face(face, x) : projector->to_curve(curve, x);
    }
    const std::vector<Vec3>& p = surface_.model.fine.points;
    Vec3 best = p[surface_.domain.chains[chains.front()].points.front()];
    for (const int c : chains) {
      const std::vector<int>& chain = surface_.domain.chains[c].points;
      for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
        const Vec3 at = nearest_on_segment(x, p[chain[i]], p[chain[i + 1]]);
        if (norm(at - x) < norm(best - x)) best = at;
      }
    }
    return best;
  }

  /// A curve and two places: nodes are told by these, for meshes number them in their own ways.
  using Key = std::tuple<int, double, double, double, double, double, double>;
  static Key key(int curve, const Vec3& a, const Vec3& b) { return {curve, a.x, a.y, a.z, b.x, b.y, b.z}; }
  /// Between two places on a chain, see CurveNode, or on its image at planes of symmetry.
  struct Span {
    int chain, planes;
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

  /// Places on planes of symmetry are no further from them, in diagonals.
  static constexpr double kOnPlane = 1e-9;

  const SurfaceSetup& surface_;
  const Mesh& mesh_;
  double tolerance_;
  std::map<Key, Span> spans_;
  std::map<std::pair<int, int>, std::vector<int>> chains_of_;  ///< by planes of symmetry and curve
  PlaceSet sliding_;
  std::optional<NearestOnRegions> facets_;  ///< of a triangulation
};

}  // namespace

std::unique_ptr<ModelGeometry> true_geometry(const MeshingSetup& prepared, const SurfaceNodes& nodes,
                                             const Mesh& mesh) {
  if (prepared.surface) return std::make_unique<SurfaceGeometry>(*prepared.surface, nodes, mesh);
  return std::make_unique<PlanarGeometry>(prepared, nodes, mesh);
}

namespace {

/// Parts of a line from whose points its tangent at the end is found, by the parabola through all three.
constexpr double kNearEnd = 0.01;

/// Away from a line's end; its length means nothing.
Vec3 tangent_at(const Mesh& mesh, const ModelGeometry& geometry, int line, int vertex) {
  const bool is_first = mesh.lines[line][0] == vertex;
  const std::array<double, 2> parts =
      is_first ? std::array{kNearEnd, 2 * kNearEnd} : std::array{1 - 2 * kNearEnd, 1 - kNearEnd};
  std::vector<Vec3> at = geometry.on_line(line, parts);
  if (!is_first) std::swap(at[0], at[1]);
  return 4.0 * at[0] - at[1] - 3.0 * mesh.points[vertex];
}

}  // namespace

std::vector<CurveCorner> curve_corners(const Mesh& straight, const ModelGeometry& geometry) {
  const auto key = [&](int a, int b) {
    const auto [lo, hi] = std::minmax(a, b);
    return static_cast<long long>(lo) * static_cast<long long>(straight.points.size()) + hi;
  };
  std::unordered_map<long long, int> line_of;  // only looked up
  for (std::size_t l = 0; l < straight.lines.size(); ++l)
    line_of.emplace(key(straight.lines[l][0], straight.lines[l][1]), static_cast<int>(l));
  const auto line_at = [&](int a, int b) {
    const auto found = line_of.find(key(a, b));
    return found == line_of.end() ? -1 : found->second;
  };
  std::vector<CurveCorner> corners;
  for (std::size_t q = 0; q < straight.quads.size(); ++q)
    for (int k = 0; k < 4; ++k) {
      const auto& v = straight.quads[q];
      const int out = line_at(v[k], v[(k + 1) % 4]), in = line_at(v[k], v[(k + 3) % 4]);
      if (out < 0 || in < 0) continue;
      const Vec3 n =
          cross(straight.points[v[2]] - straight.points[v[0]], straight.points[v[3]] - straight.points[v[1]]);
      const Vec3 a = tangent_at(straight, geometry, out, v[k]), b = tangent_at(straight, geometry, in, v[k]);
      double angle = std::atan2(dot(cross(a, b), n) / norm(n), dot(a, b));
      if (angle < -std::numbers::pi / 2) angle += 2 * std::numbers::pi;
      corners.push_back({static_cast<int>(q), k, out, in, angle});
    }
  return corners;
}

}  // namespace delquad
