// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/fields/surface/surface_metric.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "base/cancel.h"
#include "base/text.h"
#include "delquad/error.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/triangle_measures.h"
#include "geometry/surface/improve_triangulation.h"

namespace delquad {

namespace {

/// Largest turn (radians) of a side along a curved face or curve, however coarse its chords may be.
constexpr double kLargestTurn = std::numbers::pi / 3;
/// The sagitta of a straight side along a curve, in lengths across it.
constexpr double kMostSagitta = 0.2;
/// Largest factor by which a curve may shorten sides of a face without rows that end.
constexpr double kMostShorter = 1.5;
/// Growth of lengths if none is requested: for lengths by curvature, which jump, and beside curves.
constexpr double kGradation = 1.5;
/// Relative amount by which a tensor may be below the demand of gradation.
constexpr double kGraded = 1e-3;
constexpr int kMostSweeps = 200, kMostRefinings = 60, kMostScalings = 20;
/// Growth of the number of points after which the metric is composed anew.
constexpr double kMostGrowth = 1.5;
/// Share of points below which more of them are not worth to compose the metric anew.
constexpr double kFewAdded = 0.01;
/// Relative tolerance of the complexity.
constexpr double kNearComplexity = 0.005;
/// Limits of sides in the metric. Sides are halved if they are longer than kShortest and lengths along them
/// differ by more than kSteepest (as a logarithm). Sides longer than kLongest are halved in any case. For
/// metrics that are functions, sides longer than a part of the model's diagonal are halved, too.
constexpr double kShortest = 0.6, kLongest = 3, kSteepest = 0.25, kLargestSide = 1.0 / 64;
constexpr std::size_t kMostPoints = 4'000'000;

/// Returns the intersection of both, but with no length below the least of both. Planes of slivers turn from
/// point to point, so lengths would become ever smaller there.
Tensor2 finer_of(const Tensor2& a, const Tensor2& b) {
  return limited(intersection(a, b), {.min = std::min(axes_of(a).h1, axes_of(b).h1)});
}

/// Makes a tensor finer if it is below a demand. Returns whether it changed.
bool make_finer(Tensor2& m, const Tensor2& most) {
  if (is_finer(m, times(1 - kGraded, most))) return false;
  // It may stay below the demand, and should not be changed again and again then.
  const Tensor2 finer = finer_of(m, most);
  if (is_finer(m, times(1 - kGraded, finer))) return false;
  m = finer;
  return true;
}

}  // namespace

SurfaceMetric::SurfaceMetric(const SurfaceModel& model, const WantedMetric& wanted)
    : wanted_(wanted), sites_at_(model.fine.points.size()) {
  const Mesh& fine = model.fine;
  if (!(wanted_.spec.limits.max > 0)) wanted_.spec.limits.max = diagonal(fine);
  std::vector<std::tuple<int, int, Vec3>> corners;  // face, node, normal
  for (std::size_t t = 0; t < fine.triangles.size(); ++t)
    for (const int v : fine.triangles[t])
      corners.emplace_back(fine.triangle_region[t], v, area_vector(fine, t));
  std::ranges::stable_sort(corners, {}, [](const auto& c) { return std::pair(get<0>(c), get<1>(c)); });
  for (std::size_t i = 0; i < corners.size();) {
    const auto [face, node, first] = corners[i];
    Vec3 normal;
    for (; i < corners.size() && get<0>(corners[i]) == face && get<1>(corners[i]) == node; ++i)
      normal = normal + get<2>(corners[i]);
    add(face, node, fine.points[node], normal);
  }
  for (int i = 0; i < kMostScalings && !compose(model); ++i) check_cancelled();
  make_pieces(fine);
}

/// Composes the metric by the scale that the complexity so far asks for. Returns whether the complexity is as
/// asked then.
bool SurfaceMetric::compose(const SurfaceModel& model) {
  const double asked = wanted_.spec.complexity;
  if (asked > 0 && complexity_ > 0) scale_ *= std::clamp(std::sqrt(complexity_ / asked), 0.5, 2.0);
  for (Site& site : sites_) site.metric.m = within_limits(site.given.m, model.fine.points[site.node]);
  const bool grows = wanted_.spec.gradation > 1 || wanted_.spec.chord > 0;
  std::vector<char> is_less(sites_.size(), grows ? 1 : 0);
  follow_curves(model, is_less);
  grade(model.fine, std::move(is_less));
  if (!(asked > 0)) return true;
  complexity_ = 0;
  for (int t = 0; t < std::ssize(model.fine.triangles); ++t) complexity_ += area(model.fine, t);
  complexity_ *= wanted_.spec.scale * wanted_.spec.scale;
  return std::abs(complexity_ / asked - 1) < kNearComplexity;
}

int SurfaceMetric::add(int face, int node, const Vec3& x, const Vec3& normal) {
  Site site{face, node, TangentMetric::with_normal(normal), {}};
  site.given.m = given_at(face, x, site.given);
  site.metric = site.given;
  site.metric.m = within_limits(site.given.m, x);
  sites_at_.resize(std::max(sites_at_.size(), static_cast<std::size_t>(node) + 1));
  sites_at_[node].push_back(static_cast<int>(sites_.size()));
  sites_.push_back(site);
  return static_cast<int>(sites_.size()) - 1;
}

double SurfaceMetric::length_for(double curvature) const {
  const double k = std::abs(curvature);
  if (!(k > 0)) return wanted_.spec.limits.max;
  // A side strays from any arc by at most half of its length.
  const double chord = wanted_.spec.chord, least = std::min(2 * chord, wanted_.spec.limits.max);
  return std::clamp(std::min(std::sqrt(8 * chord / k), kLargestTurn / k), least, wanted_.spec.limits.max);
}

Tensor2 SurfaceMetric::given_at(int face, const Vec3& x, const TangentMetric& frame) const {
  if (wanted_.spec.chord > 0) {
    const PrincipalCurvatures k = wanted_.curvature->principal(face, x);
    const Vec2 along = frame.in_plane(k.along);
    return tensor_of({length_for(k.most), length_for(k.least), std::atan2(along.y, along.x)});
  }
  Tensor3 m;
  wanted_.spec.in_space({&x, 1}, {&m, 1});
  const auto by = [&](const Vec3& a, const Vec3& b) {
    return a.x * (m.xx * b.x + m.xy * b.y + m.xz * b.z) + a.y * (m.xy * b.x + m.yy * b.y + m.yz * b.z) +
           a.z * (m.xz * b.x + m.yz * b.y + m.zz * b.z);
  };
  const Tensor2 flat{by(frame.e, frame.e), by(frame.e, frame.f), by(frame.f, frame.f)};
  const double aspect = wanted_.spec.limits.aspect;
  if (!(flat.xx > 0 && flat.yy > 0 && determinant(flat) > 0 &&
        is_metric(aspect > 0 ? limited(flat, {.aspect = aspect}) : flat)))
    throw InputError(fmt::format(
        "{}: the metric is [{:.6g}, {:.6g}, {:.6g}, {:.6g}, {:.6g}, {:.6g}] (m11, m12, m13, m22, m23, m33) "
        "at {}: expected finite numbers and a positive definite tangent part. Its lengths may differ by a "
        "factor below {:g}, or give a largest aspect",
        wanted_.spec.where, m.xx, m.xy, m.xz, m.yy, m.yz, m.zz, show_point(x), kMostAspect));
  return flat;
}

Tensor2 SurfaceMetric::within_limits(const Tensor2& given, const Vec3& x) const {
  const double scale = wanted_.spec.scale;
  Tensor2 m = limited(times(1 / (scale_ * scale_), given), wanted_.spec.limits);
  m = times(1 / (scale * scale), m);
  for (const SizeBall& spot : wanted_.spots)
    if (norm(x - spot.at) < spot.reach) m = limited(m, {.max = spot.size});
  return m;
}

bool SurfaceMetric::shorten_along(Site& site, const Vec3& direction, double most) const {
  Tensor2& m = site.metric.m;
  const double square = metric_square((1 / norm(direction)) * direction, site.metric) * most * most;
  if (!(square < 1 - kGraded)) return false;
  const Vec2 along = site.metric.in_plane(direction);
  // Takes the curvature in all directions if rows must end or the face has no directions.
  const MetricAxes axes = axes_of(m);
  const bool is_round = wanted_.spec.chord > 0 &&
                        (square < 1 / (kMostShorter * kMostShorter) || axes.h2 < (1 + kGraded) * axes.h1);
  const double across = is_round ? most : most * kMostAspect / 10;
  m = finer_of(m, tensor_of({most, across, std::atan2(along.y, along.x)}));
  return true;
}

/// Limits sides along each curve by its chords, or by the lengths across it.
void SurfaceMetric::follow_curves(const SurfaceModel& model, std::vector<char>& is_less) {
  const Mesh& fine = model.fine;
  const auto& [spec, curvature, spots] = wanted_;
  for (std::size_t l = 0; l < fine.lines.size(); ++l)
    for (const int end : fine.lines[l]) {
      const Vec3 d = fine.points[fine.lines[l][1]] - fine.points[fine.lines[l][0]];
      const double k = curvature->of_curve(fine.line_curve[l], fine.points[end]);
      for (const int s : sites_at_[end]) {
        Site& site = sites_[s];
        if (!(k > 0) || find(site.face, fine.lines[l][0] + fine.lines[l][1] - end) == nullptr) continue;
        const Vec3 across = cross(cross(site.metric.e, site.metric.f), d);
        const double most =
            spec.chord > 0
                ? spec.scale * std::max(scale_ * length_for(k), spec.limits.min)
                : std::sqrt(8 * kMostSagitta / k / std::sqrt(metric_square(across, site.metric)) * norm(d));
        if (shorten_along(site, d, most)) is_less[s] = 1;
      }
    }
}

/// Limits the growth of lengths in sweeps, each from the changes of the one before. By curvature, lengths
/// grow with the distance in space, so that a length beside a curve soon counts in all directions. Otherwise
/// they grow with the length in the metric.
void SurfaceMetric::grade(const Mesh& fine, std::vector<char> is_new) {
  struct Link {
    int from, to;
    Vec3 way;
    bool is_curve;  ///< two faces at a point of a curve in this direction
    auto key() const { return std::pair(from, to); }
  };
  if (std::ranges::find(is_new, 1) == is_new.end()) return;
  std::vector<Link> links;
  for (std::size_t t = 0; t < fine.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = fine.triangles[t][k], b = fine.triangles[t][(k + 1) % 3], face = fine.triangle_region[t];
      const int p = static_cast<int>(find(face, a) - sites_.data()),
                q = static_cast<int>(find(face, b) - sites_.data());
      const Vec3 way = fine.points[b] - fine.points[a];
      links.push_back({p, q, way, false});
      links.push_back({q, p, way, false});
    }
  std::ranges::stable_sort(links, {}, &Link::key);
  const auto same = std::ranges::unique(links, {}, &Link::key);
  links.erase(same.begin(), same.end());
  for (const auto& [a, b] : fine.lines)
    for (const int end : {a, b})
      for (const int p : sites_at_[end])
        for (const int q : sites_at_[end])
          if (p != q && find(sites_[p].face, a + b - end) != nullptr &&
              find(sites_[q].face, a + b - end) != nullptr)
            links.push_back({p, q, fine.points[b] - fine.points[a], true});
  const bool by_curvature = wanted_.spec.chord > 0;
  const double gradation = wanted_.spec.gradation > 1 ? wanted_.spec.gradation : kGradation;
  const double slope = std::log(gradation);
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    check_cancelled();
    const std::vector<char> was_new = std::exchange(is_new, std::vector<char>(sites_.size(), 0));
    bool is_changed = false;
    for (const auto& [p, q, way, is_curve] : links) {
      if (was_new[p] + is_new[p] == 0) continue;
      const TangentMetric& from = sites_[p].metric;
      TangentMetric& to = sites_[q].metric;
      if (is_curve) {
        if (!shorten_along(sites_[q], way, norm(way) / std::sqrt(metric_square(way, from)))) continue;
      } else {
        Tensor2 most = to.seen(from);
        if (by_curvature) {
          MetricAxes axes = axes_of(most);
          axes.h1 += slope * norm(way), axes.h2 += slope * norm(way);
          most = tensor_of(axes);
        } else {
          most = grown(most, metric_length(way, from, to), gradation);
        }
        if (!make_finer(to.m, most)) continue;
      }
      is_new[q] = 1;
      is_changed = true;
    }
    if (!is_changed) return;
    std::ranges::reverse(links);
  }
}

const SurfaceMetric::Site* SurfaceMetric::find(int face, int node) const {
  if (node >= std::ssize(sites_at_)) return nullptr;
  for (const int s : sites_at_[node])
    if (sites_[s].face == face) return &sites_[s];
  return nullptr;
}

void SurfaceMetric::make_pieces(const Mesh& fine) {
  std::vector<std::vector<std::array<int, 3>>> triangles(fine.regions.size());
  std::vector<std::vector<Vec3>> points(fine.regions.size());
  std::vector<std::vector<int>> sites(fine.regions.size());
  std::vector<int> place;
  for (std::size_t s = 0; s < sites_.size(); ++s) {
    const int face = sites_[s].face;
    place.push_back(static_cast<int>(points[face].size()));
    points[face].push_back(fine.points[sites_[s].node]);
    sites[face].push_back(static_cast<int>(s));
  }
  for (std::size_t t = 0; t < fine.triangles.size(); ++t) {
    const int face = fine.triangle_region[t];
    auto& v = triangles[face].emplace_back();
    for (int k = 0; k < 3; ++k) v[k] = place[find(face, fine.triangles[t][k]) - sites_.data()];
  }
  pieces_.resize(fine.regions.size());
  for (std::size_t f = 0; f < pieces_.size(); ++f)
    if (!triangles[f].empty())
      pieces_[f].emplace(
          Piece{NearestTriangle(std::move(points[f]), std::move(triangles[f])), std::move(sites[f])});
  all_.emplace(fine.points, fine.triangles);
  face_of_ = fine.triangle_region;
}

TangentMetric SurfaceMetric::in_face(int face, const Vec3& x) const {
  const auto& [triangles, sites] = *pieces_[face];
  const NearestTriangle::Found found = triangles.find(x);
  std::array<TangentMetric, 3> corners;
  for (int k = 0; k < 3; ++k) corners[k] = sites_[sites[triangles.triangle(found.triangle)[k]]].metric;
  return log_mean(corners, found.weights);
}

TangentMetric SurfaceMetric::at_node(const Mesh& fine, int face, int node) const {
  const Site* site = find(face, node);
  return site != nullptr ? site->metric : in_face(face, fine.points[node]);
}

double SurfaceMetric::length(const Mesh& fine, int face, int a, int b) const {
  return metric_length(fine.points[b] - fine.points[a], at_node(fine, face, a), at_node(fine, face, b));
}

double SurfaceMetric::area(const Mesh& fine, int triangle) const {
  const auto& [a, b, c] = fine.triangles[triangle];
  double log = 0;
  for (const int v : {a, b, c})
    log += std::log(determinant(at_node(fine, fine.triangle_region[triangle], v).m)) / 6;
  return norm(area_vector(fine, static_cast<std::size_t>(triangle))) / 2 * std::exp(log);
}

std::map<std::pair<int, int>, double> SurfaceMetric::stretches_of_lines(const Mesh& fine) const {
  std::map<std::pair<int, int>, double> stretches;
  const std::vector<HalfEdge> sides = sorted_half_edges(fine);
  for (const auto& [a, b] : fine.lines) {
    double& stretch = stretches[std::minmax(a, b)];
    for (const HalfEdge& side : sides_of_edge(std::span(sides), a, b))
      stretch = std::max(stretch, length(fine, fine.triangle_region[side.element], a, b) /
                                      norm(fine.points[b] - fine.points[a]));
  }
  return stretches;
}

double SurfaceMetric::at(const Vec3& x, int& hint) const {
  const NearestTriangle::Found found = all_->find_from(hint, x);
  hint = found.triangle;
  return std::pow(determinant(in_face(face_of_[found.triangle], x).m), -0.25);
}

/// Decides which triangles to split, and gives new points their metric.
class MetricRule final : public RefinementRule {
 public:
  MetricRule(const Mesh& fine, SurfaceMetric& metric)
      : fine_(fine),
        metric_(metric),
        largest_(kLargestSide * diagonal(fine)),
        most_points_(static_cast<std::size_t>(kMostGrowth * static_cast<double>(fine.points.size()))) {}

  int n_added() const { return n_added_; }
  bool has_lengths() const override { return true; }
  double length(int face, int a, int b, double) const override { return metric_.length(fine_, face, a, b); }
  double cotangents(int face, const std::array<int, 4>& abcd) const override {
    const TangentMetric& frame = metric_.find(face, abcd[0])->metric;
    Tensor2 sum{0, 0, 0};
    std::array<Vec2, 4> x;
    for (int k = 0; k < 4; ++k) {
      const SurfaceMetric::Site* site = metric_.find(face, abcd[k]);
      if (site == nullptr) return 0;  // beyond a line, which stays
      const Tensor2 m = frame.seen(site->metric);
      sum = {sum.xx + m.xx, sum.xy + m.xy, sum.yy + m.yy};
      x[k] = frame.in_plane(fine_.points[abcd[k]] - fine_.points[abcd[0]]);
    }
    const auto cotangent = [&](int tip) {
      const Vec2 p = x[0] - x[tip], q = x[1] - x[tip];
      return (sum.xx * p.x * q.x + sum.xy * (p.x * q.y + p.y * q.x) + sum.yy * p.y * q.y) /
             (std::abs(cross(p, q)) * std::sqrt(determinant(sum)));
    };
    return cotangent(2) + cotangent(3);
  }

  bool is_too_large(int face, const std::array<int, 3>& nodes, const std::array<int, 3>&) const override {
    return fine_.points.size() <= most_points_ &&
           (may_split(face, nodes[0], nodes[1]) || may_split(face, nodes[1], nodes[2]) ||
            may_split(face, nodes[2], nodes[0]));
  }
  bool may_split(int face, int a, int b) const override {
    const TangentMetric &at_a = metric_.find(face, a)->metric, &at_b = metric_.find(face, b)->metric;
    const Vec3 d = fine_.points[b] - fine_.points[a];
    const double by_metric = metric_length(d, at_a, at_b);
    return by_metric > kLongest || (metric_.wanted_.spec.chord == 0 && norm(d) > largest_) ||
           (by_metric > kShortest && difference(at_a.m, at_a.seen(at_b)) > kSteepest);
  }

  void node_added(int node, int a, int b, int, int) override {
    if (fine_.points.size() > kMostPoints)
      throw InputError(fmt::format(
          "{}: the metric changes too fast to be followed by {} points: a gradation or a larger least "
          "length helps [metric-too-fast]",
          metric_.wanted_.spec.where, kMostPoints));
    const std::vector<int> at_a = metric_.sites_at_[a];
    for (const int s : at_a) {
      const SurfaceMetric::Site first = metric_.sites_[s];
      const SurfaceMetric::Site* other = metric_.find(first.face, b);
      if (other == nullptr) continue;
      const TangentMetric &p = first.metric, q = other->metric;
      TangentMetric& made =
          metric_.sites_[metric_.add(first.face, node, fine_.points[node], cross(p.e, p.f) + cross(q.e, q.f))]
              .metric;
      made.m = intersection(made.m, log_mean(std::array{made.seen(p), made.seen(q)}, std::array{0.5, 0.5}));
    }
    ++n_added_;
  }

 private:
  const Mesh& fine_;
  SurfaceMetric& metric_;
  double largest_;
  std::size_t most_points_;  ///< before the metric is composed anew
  int n_added_ = 0;
};

std::shared_ptr<const SurfaceMetric> refine_for_metric(SurfaceModel& model, const WantedMetric& wanted) {
  const auto metric = std::make_shared<SurfaceMetric>(model, wanted);
  // The metric is composed anew whenever there are more points. It is done if nothing is left to halve then.
  for (int round = 0; round < kMostRefinings; ++round) {
    check_cancelled();
    MetricRule rule(model.fine, *metric);
    refine_triangulation(model, rule);
    if (!metric->compose(model)) continue;
    if (rule.n_added() <= kFewAdded * static_cast<double>(model.fine.points.size())) break;
  }
  metric->make_pieces(model.fine);
  return metric;
}

}  // namespace delquad
