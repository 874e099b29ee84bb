// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/fields/surface/surface_size.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <unordered_map>

#include "algorithms/fields/fields.h"
#include "algorithms/fields/surface/surface_metric.h"
#include "base/cancel.h"
#include "base/parallel.h"
#include "base/sort_unique.h"
#include "geometry/surface/curve_chains.h"
#include "geometry/surface/improve_triangulation.h"

namespace delquad {

namespace {

/// Largest length of edges beside a short curve, over its own edge, and least length over the base. Least
/// number of edges of a closed curve.
constexpr double kBesideShort = 4, kLeastBeside = 1.0 / 50, kLoopEdges = 4;
/// Largest distance of a point from the surface, over the base, at which smaller sizes count.
constexpr double kOffSurface = 0.1;
/// Largest factor between linear values and true sizes.
constexpr double kMiss = 1.25;
/// Length of sides, in sizes, that are not split.
constexpr double kShortSide = 1;
/// Longest side, over the diagonal, for a base that varies.
constexpr double kCoarsest = 1.0 / 64;
/// Limit of rounds that refine and limit sizes again.
constexpr int kMostRounds = 4;

/// A point of the triangulation and an entity with this point.
struct Incidence {
  int node, entity;
  friend auto operator<=>(const Incidence&, const Incidence&) = default;
};

/// Returns the least size of the faces and curves at each point, without the limit of gradation.
std::vector<double> wanted_at_points(const Mesh& fine, const WantedSize& wanted) {
  std::vector<Incidence> in_faces, on_curves;
  for (std::size_t t = 0; t < fine.triangles.size(); ++t)
    for (const int v : fine.triangles[t]) in_faces.push_back({v, fine.triangle_region[t]});
  for (std::size_t l = 0; l < fine.lines.size(); ++l)
    for (const int v : fine.lines[l]) on_curves.push_back({v, fine.line_curve[l]});
  sort_unique(in_faces);
  sort_unique(on_curves);

  constexpr std::size_t kBlock = 256;
  std::vector<double> values(in_faces.size() + on_curves.size());
  parallel_for((values.size() + kBlock - 1) / kBlock, [&](std::size_t block) {
    for (std::size_t i = block * kBlock; i < std::min(values.size(), (block + 1) * kBlock); ++i) {
      const bool face = i < in_faces.size();
      const auto [node, entity] = face ? in_faces[i] : on_curves[i - in_faces.size()];
      values[i] =
          face ? wanted.in_face(entity, fine.points[node]) : wanted.on_curve(entity, fine.points[node]);
    }
  });
  std::vector<double> delta(fine.points.size(), INFINITY);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const int node = i < in_faces.size() ? in_faces[i].node : on_curves[i - in_faces.size()].node;
    delta[node] = std::min(delta[node], values[i]);
  }
  return delta;
}

/// Returns the least T + slope |p - x| over the points p of side a, b, with T linear along it.
double least_through(const Vec3& x, const Vec3& a, double ta, const Vec3& b, double tb, double slope) {
  const Vec3 side = b - a;
  const double length = norm(side);
  if (!(length > 0)) return std::min(ta, tb) + slope * norm(x - a);
  const double foot = dot(x - a, side) / length;
  const double height = norm(x - a - (foot / length) * side);
  const double k = (tb - ta) / (slope * length);
  double along = k > 0 ? 0 : length;
  if (std::abs(k) < 1) along = std::clamp(foot - height * k / std::sqrt(1 - k * k), 0.0, length);
  const double t = along / length;
  return (1 - t) * ta + t * tb + slope * std::hypot(height, along - foot);
}

/// Decides which triangles are too large for sizes that are linear on them.
class SizeRule final : public RefinementRule {
 public:
  SizeRule(const Mesh& fine, const WantedSize& wanted, double coarsest)
      : fine_(fine),
        wanted_(wanted),
        coarsest_(coarsest),
        raw_(wanted_at_points(fine, wanted)),
        delta_(raw_) {
    limit_slope(fine, wanted.gradation, delta_);
  }

  int n_added() const { return n_added_; }

  bool is_too_large(int face, const std::array<int, 3>& nodes,
                    const std::array<int, 3>& curve) const override {
    double longest = 0;
    for (int k = 0; k < 3; ++k) {
      const int a = nodes[(k + 1) % 3], b = nodes[(k + 2) % 3];
      const double length = norm(fine_.points[b] - fine_.points[a]);
      longest = std::max(longest, length);
      if (length > kShortSide * std::min(delta_[a], delta_[b]) && misses(face, a, b, length, curve[k]))
        return true;
    }
    return (longest > coarsest_ && longest > kShortSide * least(nodes)) || may_hide_spot(nodes, longest);
  }

  void node_added(int node, int a, int b, int face, int curve) override {
    const Vec3& x = fine_.points[node];
    const double raw = curve < 0 ? wanted_.in_face(face, x) : std::min(raw_on(curve, a, b), base(x));
    raw_.resize(node + 1, raw);
    delta_.resize(node + 1, 0);
    delta_[node] = raw;
    for (const int end : {a, b})
      delta_[node] = std::min(delta_[node], delta_[end] + wanted_.gradation * norm(x - fine_.points[end]));
    ++n_added_;
  }

 private:
  double base(const Vec3& x) const {
    int hint = -1;
    return wanted_.base->at(x, hint);
  }

  double least(const std::array<int, 3>& nodes) const {
    return std::min({delta_[nodes[0]], delta_[nodes[1]], delta_[nodes[2]]});
  }

  /// Returns whether a ball of small sizes inside or beside the triangle might be missed.
  bool may_hide_spot(const std::array<int, 3>& nodes, double longest) const {
    const Vec3 sum = fine_.points[nodes[0]] + fine_.points[nodes[1]] + fine_.points[nodes[2]];
    return std::ranges::any_of(wanted_.spots, [&](const SizeBall& spot) {
      return longest > spot.reach && norm((1.0 / 3) * sum - spot.at) < longest + spot.reach;
    });
  }

  /// Returns whether the mean of the ends is far from the size in the middle of the side.
  bool misses(int face, int a, int b, double length, int curve) const {
    const double linear = (delta_[a] + delta_[b]) / 2;
    const double in_middle = base(0.5 * (fine_.points[a] + fine_.points[b]));
    const double own = curve >= 0 ? raw_on(curve, a, b) : std::max(raw(face, a), raw(face, b));
    const double most =
        std::min({in_middle, own, std::min(delta_[a], delta_[b]) + wanted_.gradation * length / 2});
    return most > kMiss * linear || linear > kMiss * in_middle;
  }

  /// Returns the size of a curve alone on its side from a to b, since the ends may belong to shorter curves.
  /// If sizes follow curvature, this is the larger size of both ends.
  double raw_on(int curve, int a, int b) const {
    if (wanted_.curvature) return std::max(raw_[a], raw_[b]);
    return std::max(wanted_.on_curve(curve, fine_.points[a]), wanted_.on_curve(curve, fine_.points[b]));
  }

  /// Returns the size of the face alone at one of its points.
  double raw(int face, int node) const {
    if (!wanted_.curvature) return wanted_.in_face(face, fine_.points[node]);
    const auto [at, fresh] = face_raw_.try_emplace(static_cast<long long>(face) << 32 | node, 0.0);
    if (fresh) at->second = wanted_.in_face(face, fine_.points[node]);
    return at->second;
  }

  const Mesh& fine_;
  const WantedSize& wanted_;
  double coarsest_;
  std::vector<double> raw_, delta_;  ///< sizes of each point without and with the limit of gradation
  mutable std::unordered_map<long long, double> face_raw_;  // only looked up, never iterated
  int n_added_ = 0;
};

bool varies(const Mesh& fine, const SizeField& base) {
  int hint = -1;
  const double first = base.at(fine.points[0], hint);
  return std::ranges::any_of(fine.points, [&](const Vec3& x) { return base.at(x, hint) != first; });
}

}  // namespace

double WantedSize::of(const std::vector<double>& own, int entity) const {
  const bool has_own = static_cast<std::size_t>(entity) < own.size() && own[entity] != 0;
  return has_own ? own[entity] : per_turn;
}

double WantedSize::in_face(int face, const Vec3& x) const {
  int hint = -1;
  const double size = base->at(x, hint);
  return at_most_by_spots(
      curvature ? size_by_curvature(size, curvature->of_face(face, x), of(face_per_turn, face), min) : size,
      x);
}

double WantedSize::on_curve(int curve, const Vec3& x) const {
  int hint = -1;
  const double size = base->at(x, hint);
  const bool has_limit = static_cast<std::size_t>(curve) < curve_limit.size();  // cuts have none
  const double limited = has_limit ? std::min(size, curve_limit[curve]) : size;
  return at_most_by_spots(
      curvature ? size_by_curvature(limited, curvature->of_curve(curve, x), of(curve_per_turn, curve), min)
                : limited,
      x);
}

double WantedSize::at_most_by_spots(double size, const Vec3& x) const {
  for (const SizeBall& spot : spots)
    if (norm(x - spot.at) < spot.reach) size = std::min(size, spot.size);
  return size;
}

std::vector<double> sizes_beside_short_curves(const Mesh& fine, const SizeField& base) {
  if (fine.points.empty() || varies(fine, base)) return {};
  int hint = -1;
  const double size = base.at(fine.points[0], hint);
  const std::vector<double> length = lengths_of_curves(fine);
  const std::vector<std::vector<int>> points = points_of_curves(fine);
  std::vector<double> limit;
  for (std::size_t c = 0; c < length.size(); ++c) {
    const bool is_closed = points[c].empty() || points[c].front() == points[c].back();
    const double edge = length[c] / (is_closed ? kLoopEdges : 1);
    limit.push_back(std::max(kBesideShort * edge, kLeastBeside * size));
  }
  const bool asks = std::ranges::any_of(limit, [&](double x) { return x < size; });
  return asks ? limit : std::vector<double>{};
}

void limit_slope(const Mesh& fine, double slope, std::vector<double>& values) {
  std::vector<int> start(fine.points.size() + 1, 0);
  for (const auto& t : fine.triangles)
    for (const int v : t) ++start[v + 1];
  for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
  std::vector<int> around(start.back()), next(start.begin(), start.end() - 1);
  for (std::size_t t = 0; t < fine.triangles.size(); ++t)
    for (const int v : fine.triangles[t]) around[next[v]++] = static_cast<int>(t);

  // Values become final in ascending order, as in Dijkstra's method.
  using Entry = std::pair<double, int>;
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < values.size(); ++i) entries.push_back({values[i], static_cast<int>(i)});
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue(std::greater<>{}, std::move(entries));
  std::vector<char> is_final(values.size(), 0);
  const auto lower_to = [&](int v, double value) {
    if (is_final[v] || !(value < values[v])) return;
    values[v] = value;
    queue.push({value, v});
  };
  while (!queue.empty()) {
    check_cancelled();
    const auto [value, v] = queue.top();
    queue.pop();
    if (is_final[v] || value > values[v]) continue;
    is_final[v] = 1;
    const Vec3& at = fine.points[v];
    for (int i = start[v]; i < start[v + 1]; ++i) {
      const auto& t = fine.triangles[around[i]];
      const int k = t[0] == v ? 0 : t[1] == v ? 1 : 2;
      const int a = t[(k + 1) % 3], b = t[(k + 2) % 3];
      for (const auto& [to, other] : {std::pair(a, b), std::pair(b, a)}) {
        const Vec3& x = fine.points[to];
        lower_to(to, is_final[other] ? least_through(x, at, value, fine.points[other], values[other], slope)
                                     : value + slope * norm(x - at));
      }
    }
  }
}

SurfaceSize::SurfaceSize(std::shared_ptr<const SizeField> base) : base_(std::move(base)) {}

SurfaceSize::SurfaceSize(const SurfaceModel& model, const WantedSize& wanted)
    : base_(wanted.base), edge_turn_(wanted.edge_turn), metric_(wanted.metric) {
  if (metric_) line_stretch_ = metric_->stretches_of_lines(model.fine);
  if (!wanted.depends_on_surface()) return;
  delta_ = wanted_at_points(model.fine, wanted);
  limit_slope(model.fine, wanted.gradation, delta_);
  std::vector<std::array<int, 3>> triangles;
  int hint = -1;
  const auto is_less = [&](int v) { return delta_[v] < base_->at(model.fine.points[v], hint); };
  std::ranges::copy_if(model.fine.triangles, std::back_inserter(triangles),
                       [&](const auto& t) { return std::ranges::any_of(t, is_less); });
  if (!triangles.empty()) triangles_.emplace(model.fine.points, std::move(triangles));
}

double SurfaceSize::on_fine(std::span<const int> nodes, std::span<const double> weights, const Vec3& x,
                            int& hint) const {
  const double base = base_->at(x, hint);
  if (delta_.empty()) return base;
  double delta = 0;
  for (std::size_t k = 0; k < nodes.size(); ++k) delta += weights[k] * delta_[nodes[k]];
  return std::min(base, delta);
}

double SurfaceSize::along_line(int a, int b, double t, const Vec3& x, int& hint) const {
  const double size = on_fine(std::array{a, b}, std::array{1 - t, t}, x, hint);
  return metric_ ? size / line_stretch_.at(std::minmax(a, b)) : size;
}

double SurfaceSize::quads_in(const Mesh& fine, int triangle, int& hint) const {
  constexpr double kThird[] = {1.0 / 3, 1.0 / 3, 1.0 / 3};
  const auto& v = fine.triangles[triangle];
  const Vec3 a = fine.points[v[0]], b = fine.points[v[1]], c = fine.points[v[2]];
  const double delta = on_fine(v, kThird, (1.0 / 3) * (a + b + c), hint);
  const double area = metric_ ? metric_->area(fine, triangle) : norm(cross(b - a, c - a)) / 2;
  return area / (delta * delta);
}

double SurfaceSize::at(const Vec3& x, int& hint) const {
  if (metric_) return metric_->at(x, hint);
  const double base = base_->at(x, hint);
  if (!triangles_) return base;
  const NearestTriangle::Found found = triangles_->find(x, kOffSurface * base);
  if (found.triangle < 0) return base;
  return on_fine(triangles_->triangle(found.triangle), found.weights, x, hint);
}

void refine_for_size(SurfaceModel& model, const WantedSize& wanted) {
  if (!wanted.depends_on_surface() || model.fine.triangles.empty()) return;
  const double coarsest = varies(model.fine, *wanted.base) ? kCoarsest * diagonal(model.fine) : INFINITY;
  for (int round = 0; round < kMostRounds; ++round) {
    SizeRule rule(model.fine, wanted, coarsest);
    refine_triangulation(model, rule);
    if (rule.n_added() == 0) return;
  }
}

}  // namespace delquad
