// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/cut_planner.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
#include <queue>
#include <tuple>
#include <utility>

#include "base/segment.h"
#include "geometry/surface/laplacian.h"

namespace delquad {

namespace {

constexpr int kMaxStarts = 16;  ///< limit of tried paths from one loop
/// Extra cost of a path, over its length, for an end that becomes a new corner.
constexpr double kNewCorner = 0.15, kNewCornerAtStart = 0.05;
/// Extra cost of a path that runs into a third loop, and of one beside a point that nodes have to keep.
constexpr double kWrongLoop = 2, kBesidePoint = 2;
/// Part of the length of a path within which it runs beside a point.
constexpr double kBeside = 0.03;
/// The least angular defect of a sharp tip (radians), and the angle around a blunt one.
constexpr double kTipDefect = 0.5, kBluntTip = 200 * std::numbers::pi / 180;

class PathChoice {
 public:
  PathChoice(const Chart& chart, const std::vector<CutEnd>& ends, int tip = -1)
      : chart_(chart), ends_(ends), around_(triangles_around(chart)) {
    for (std::size_t v = chart.n_boundary; v < chart.points.size(); ++v)
      if (const int i = static_cast<int>(v); i != tip && end_of(i) == CutEnd::kCorner) inner_.push_back(i);
  }

  // Tries paths from these starts; `down` falls towards `target`.
  void try_from(const std::vector<int>& starts, const std::vector<double>& down,
                const std::vector<char>& target) {
    for (int start : starts) {
      std::optional<CutPath> path = descend(chart_, around_, down, start, target);
      if (!path) continue;
      const EdgePoint& last = path->points.back();
      double factor = 1 + end_cost(end_of(start)) + end_cost(last.b < 0 ? end_of(last.a) : CutEnd::kAnywhere);
      if (!target[last.a]) factor += kWrongLoop;
      factor += kBesidePoint * nearness(*path);
      if (factor * path->length < cost_) {
        cost_ = factor * path->length;
        best_ = std::move(path);
      }
    }
  }

  /// Returns the loop's corners; without these, or if points inside may be in the way, starts of its curves
  /// and points spread along it, too.
  std::vector<int> starts(const std::vector<int>& loop) const {
    std::vector<int> corners, begins;
    for (int v : loop) {
      if (end_of(v) == CutEnd::kCorner) corners.push_back(v);
      if (end_of(v) == CutEnd::kCurveStart) begins.push_back(v);
    }
    std::vector<int> some = spread(corners);
    if (!some.empty() && inner_.empty()) return some;
    const std::vector<int> all = spread(loop);
    some.insert(some.end(), begins.begin(), begins.end());
    some.insert(some.end(), all.begin(), all.end());
    return some;
  }

  std::optional<CutPath> best() && { return std::move(best_); }

 private:
  CutEnd end_of(int v) const { return ends_[chart_.fine_node[v]]; }

  static double end_cost(CutEnd end) {
    return end == CutEnd::kCorner ? 0 : end == CutEnd::kCurveStart ? kNewCornerAtStart : kNewCorner;
  }

  /// Returns how near a path runs to a corner inside that is not on it, from 0 to 1. Beyond kBeside of its
  /// length it is 0.
  double nearness(const CutPath& path) const {
    double least = kBeside * path.length;
    for (const int v : inner_) {
      if (std::ranges::find(path.points, EdgePoint{v}) != path.points.end()) continue;
      for (std::size_t i = 1; i < path.points.size(); ++i)
        least = std::min(least, distance_to_segment(chart_.points[v], position(chart_, path.points[i - 1]),
                                                    position(chart_, path.points[i])));
    }
    return path.length > 0 ? 1 - least / (kBeside * path.length) : 0;
  }

  static std::vector<int> spread(const std::vector<int>& all) {
    const std::size_t n = std::min<std::size_t>(all.size(), kMaxStarts);
    std::vector<int> some;
    for (std::size_t i = 0; i < n; ++i) some.push_back(all[i * all.size() / n]);
    return some;
  }

  const Chart& chart_;
  const std::vector<CutEnd>& ends_;
  std::vector<std::vector<int>> around_;
  std::vector<int> inner_;  ///< corners inside, except the tip
  double cost_ = std::numeric_limits<double>::infinity();
  std::optional<CutPath> best_;
};

std::vector<double> negated(std::vector<double> u) {
  for (double& value : u) value = -value;
  return u;
}

/// Areas of the vertices on both sides of a curve; 0 on one side if the curve separates nothing.
class Separation {
 public:
  explicit Separation(const Chart& chart)
      : chart_(chart), around_(triangles_around(chart)), areas_(vertex_areas(chart)) {}

  double smaller_side(const LevelCurve& curve) const {
    const auto [start, beyond] = curve.crossed.front();
    std::vector<char> reached(areas_.size(), 0), beside(areas_.size(), 0);
    for (const auto& [a, b] : curve.crossed) beside[a] = beside[b] = 1;
    std::vector<int> stack = {start};
    reached[start] = 1;
    double area = 0;
    while (!stack.empty()) {
      const int v = stack.back();
      stack.pop_back();
      area += areas_[v];
      for (int t : around_[v])
        for (int w : chart_.triangles[t])
          if (!reached[w] &&
              !(beside[v] && beside[w] &&
                std::ranges::binary_search(curve.crossed, std::pair(std::min(v, w), std::max(v, w))))) {
            reached[w] = 1;
            stack.push_back(w);
          }
    }
    return reached[beyond] ? 0 : std::min(area, total() - area);
  }
  const std::vector<double>& areas() const { return areas_; }
  double total() const { return std::accumulate(areas_.begin(), areas_.end(), 0.0); }

 private:
  const Chart& chart_;
  std::vector<std::vector<int>> around_;
  std::vector<double> areas_;
};

/// Returns the levels below which 1/16, 2/16, ... of the chart's area lie.
std::vector<double> levels(const std::vector<double>& u, const std::vector<double>& areas) {
  constexpr int kParts = 16;
  std::vector<std::pair<double, double>> sorted;
  for (std::size_t v = 0; v < u.size(); ++v) sorted.push_back({u[v], areas[v]});
  std::ranges::sort(sorted);
  const double total = std::accumulate(areas.begin(), areas.end(), 0.0);
  std::vector<double> found;
  double sum = 0;
  for (std::size_t i = 0; i + 1 < sorted.size() && found.size() + 1 < kParts; ++i) {
    sum += sorted[i].second;
    if (sum * kParts >= static_cast<double>(found.size() + 1) * total &&
        sorted[i].first < sorted[i + 1].first)
      found.push_back((sorted[i].first + sorted[i + 1].first) / 2);
  }
  return found;
}

/// Distances of triangles, from neighbor to neighbor, to the nearest of some seeds: this seed, and the
/// farthest triangle.
struct Spread {
  std::vector<int> seed_of;
  int farthest = 0;
};

Spread spread_from(const Chart& chart, const std::vector<int>& seeds) {
  const auto centroid = [&](int t) {
    const auto& [a, b, c] = chart.triangles[t];
    return 1.0 / 3 * (chart.points[a] + chart.points[b] + chart.points[c]);
  };
  Spread spread{std::vector<int>(chart.triangles.size(), -1), 0};
  using Entry = std::tuple<double, int, int>;  // distance, triangle, seed
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (std::size_t i = 0; i < seeds.size(); ++i) queue.emplace(0, seeds[i], static_cast<int>(i));
  while (!queue.empty()) {
    const auto [way, t, seed] = queue.top();
    queue.pop();
    if (spread.seed_of[t] >= 0) continue;
    spread.seed_of[t] = seed;
    spread.farthest = t;
    for (int u : chart.neighbours[t])
      if (u >= 0 && spread.seed_of[u] < 0) queue.emplace(way + norm(centroid(u) - centroid(t)), u, seed);
  }
  return spread;
}

}  // namespace

std::vector<char> plan_split(const Chart& chart) {
  if (chart.triangles.size() < 2) return {};
  const int first = spread_from(chart, {0}).farthest, second = spread_from(chart, {first}).farthest;
  const std::vector<int> seed_of = spread_from(chart, {first, second}).seed_of;
  return {seed_of.begin(), seed_of.end()};
}

std::optional<CutPath> plan_seam(const Chart& chart, const std::vector<CutEnd>& ends) {
  const std::size_t n = chart.points.size();
  std::vector<char> on_first(n, 0), on_second(n, 0), fixed(n, 0);
  std::vector<double> u(n, 0.0);
  for (int v : chart.loops[0]) on_first[v] = fixed[v] = 1;
  for (int v : chart.loops[1]) {
    on_second[v] = fixed[v] = 1;
    u[v] = 1;
  }
  u = LaplaceSolver(chart, fixed).solve(u, std::vector<double>(n, 0.0));
  PathChoice choice(chart, ends);
  choice.try_from(choice.starts(chart.loops[1]), u, on_first);
  choice.try_from(choice.starts(chart.loops[0]), negated(u), on_second);
  return std::move(choice).best();
}

std::vector<int> sharp_tips(const Chart& chart) {
  constexpr std::size_t kMaxTips = 8;
  const std::vector<double> defects = angle_defects(chart);
  std::vector<int> tips;
  double in_tips = 0, all = 0;
  for (std::size_t v = static_cast<std::size_t>(chart.n_boundary); v < defects.size(); ++v) {
    all += std::abs(defects[v]);
    if (defects[v] > kTipDefect) {
      tips.push_back(static_cast<int>(v));
      in_tips += defects[v];
    }
  }
  if (tips.size() > kMaxTips || in_tips < all / 2) tips.clear();
  return tips;
}

std::optional<CutPath> plan_tip_cut(const Chart& chart, int tip, const std::vector<CutEnd>& ends) {
  const std::size_t n = chart.points.size();
  std::vector<char> boundary(n, 0), fixed(n, 0), at_tip(n, 0);
  std::fill_n(boundary.begin(), chart.n_boundary, 1);
  fixed = boundary;
  fixed[tip] = at_tip[tip] = 1;
  std::vector<double> u(n, 0.0);
  u[tip] = 1;
  u = LaplaceSolver(chart, fixed).solve(u, std::vector<double>(n, 0.0));
  PathChoice choice(chart, ends, tip);
  choice.try_from({tip}, u, boundary);
  for (const auto& loop : chart.loops) choice.try_from(choice.starts(loop), negated(u), at_tip);
  return std::move(choice).best();
}

std::optional<CutPath> plan_cut_through_tip(const Chart& chart, const std::vector<CutEnd>& ends,
                                            const std::vector<char>& on_cut) {
  const std::vector<int>& loop = chart.loops[0];
  const std::size_t n = loop.size();
  const auto node = [&](std::size_t i) { return chart.fine_node[loop[i % n]]; };
  for (std::size_t i = 0; i < n; ++i) {
    // Follows both sides of the cut as long as they have the same nodes.
    std::size_t length = 0;
    while (2 * length + 3 < n && node(i + n - length - 1) == node(i + length + 1)) ++length;
    if (length == 0) continue;
    const double angle = std::numbers::pi - angle_defects(chart)[loop[i]];
    if (angle < kBluntTip || angle > 2 * std::numbers::pi - kTipDefect) continue;
    std::vector<char> rim(chart.points.size(), 0);
    bool is_cut = false;
    for (std::size_t k = length + 1; k + length < n; ++k) {
      rim[loop[(i + k) % n]] = 1;
      is_cut |= k > length + 1 && on_cut[node(i + k - 1)] && on_cut[node(i + k)];
    }
    if (is_cut) continue;
    std::vector<char> fixed = rim;
    std::vector<double> u(chart.points.size(), 0.0);
    fixed[loop[i]] = 1;
    u[loop[i]] = 1;
    PathChoice choice(chart, ends);
    choice.try_from({loop[i]}, LaplaceSolver(chart, fixed).solve(u, std::vector<double>(u.size(), 0.0)), rim);
    if (auto path = std::move(choice).best()) return path;
  }
  return std::nullopt;
}

std::optional<CutPath> plan_division(const Chart& chart) {
  constexpr std::size_t kMaxPieces = 6;  // longest pieces of one level that are examined
  constexpr double kSmallestPart = 0.08;
  const std::vector<double> u = fiedler_function(chart);
  const Separation separation(chart);
  const double total = separation.total();
  const bool handles = genus(chart) > 0;
  std::optional<CutPath> best;
  double best_cost = std::numeric_limits<double>::infinity();
  for (double level : levels(u, separation.areas())) {
    std::vector<LevelCurve> pieces = level_curves(chart, u, level);
    std::ranges::stable_sort(pieces, std::greater{}, [](const LevelCurve& c) { return c.path.length; });
    if (pieces.size() > kMaxPieces) pieces.resize(kMaxPieces);
    for (LevelCurve& piece : pieces) {
      const double side = separation.smaller_side(piece);
      const bool separates = side > 0;
      if (separates && side < kSmallestPart * total) continue;
      // A cut that removes a handle is much better than one that does not.
      const double cost =
          separates ? piece.path.length / side * (handles ? 4 : 1) : piece.path.length / total;
      if (cost < best_cost) {
        best_cost = cost;
        best = std::move(piece.path);
      }
    }
  }
  return best;
}

}  // namespace delquad
