// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/metric/metric_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "algorithms/fields/sample_triangle.h"
#include "algorithms/fields/tangent_metric.h"
#include "base/cancel.h"
#include "base/located.h"
#include "base/predicates.h"
#include "base/sort_unique.h"
#include "base/text.h"
#include "delquad/error.h"
#include "geometry/mesh/constrained_delaunay.h"
#include "geometry/surface/surface_editor.h"

namespace delquad {
namespace {

/// No side is longer than this part of the domain's diagonal: what the metric does within half of that is
/// seen.
constexpr double kLargestSide = 1.0 / 64;
/// In the metric: longer sides are halved where lengths along them differ by more than kSteepest (as a
/// logarithm), and the longest whatever they do.
constexpr double kShortest = 0.6, kLongest = 3, kSteepest = 0.25;
/// Chords of curves stray from these by no more than this part of their length.
constexpr double kChordSag = 0.02;
/// The sagitta of a straight side along a curve, or along directions that bend, in lengths across it.
constexpr double kMostSagitta = 0.2;
/// Directions mean something where lengths differ by this factor.
constexpr double kStretched = 2;
/// Lengths that differ by less, as a logarithm, are a size without directions.
constexpr double kIsotropic = 1e-9;
constexpr int kMostRounds = 200, kGradationSweeps = 200;
constexpr double kMorePoints = 1.2;
/// The growth of lengths away from bends, where none is asked for.
constexpr double kBendGradation = 1.5;
/// Relative amount by which a tensor may be below the demand of gradation.
constexpr double kGraded = 1e-3;
constexpr std::size_t kMostPoints = 4'000'000;
/// How near the complexity comes to what is asked.
constexpr double kNearComplexity = 0.005;
/// Cotangents that add up to less are rounding.
constexpr double kFlip = -1e-9;

long long key_of(int a, int b) { return (static_cast<long long>(std::min(a, b)) << 32) | std::max(a, b); }
Vec2 flat(const Vec3& x) { return {x.x, x.y}; }
double product(Vec2 a, const Tensor2& m, Vec2 b) {
  return m.xx * a.x * b.x + m.xy * (a.x * b.y + a.y * b.x) + m.yy * a.y * b.y;
}

class MetricMesher {
 public:
  MetricMesher(const PlanarDomain& domain, const MetricFunction& function, const MetricSpec& spec,
               long long max_elements)
      : domain_(domain), function_(function), spec_(spec), max_elements_(max_elements) {
    take_domain();
    longest_ = diagonal(model_.fine) * kLargestSide;
  }

  MetricMesh run() {
    SurfaceEditor editor(model_);
    sample();
    update_metric();
    flip_all(editor);
    // The metric is composed anew once there are more points, and at the end: that nothing is left to halve
    // by it then, ends it.
    std::size_t known = metric_.size();
    bool is_settled = false;
    for (int round = 0; round < kMostRounds; ++round) {
      check_cancelled();
      const bool is_done = refine(editor) == 0;
      if (is_done && is_settled && is_at_complexity()) break;
      if (!is_done && static_cast<double>(metric_.size()) < kMorePoints * static_cast<double>(known))
        continue;
      update_metric();
      known = metric_.size();
      is_settled = is_done;
    }
    flip_all(editor);
    editor.finish();
    const bool is_isotropic = has_no_directions();
    MetricMesh made{
        std::move(model_.fine), std::move(metric_), {}, complexity_, scale_, shortened_, is_isotropic};
    for (const auto& [a, b] : made.fine.lines) made.segments.push_back(segments_.at(key_of(a, b)));
    return made;
  }

 private:
  void take_domain() {
    Mesh& fine = model_.fine;
    fine.points = domain_.boundary.points;
    fine.regions.resize(1);
    for (const PatchBoundary& patch : domain_.patches)
      for (const auto& v : constrained_delaunay(patch).triangles) {
        const auto& node = patch.point_node;
        fine.triangles.push_back({node[v[0]], node[v[1]], node[v[2]]});
        if (const auto& [a, b, c] = fine.triangles.back(); orient2d(at(a), at(b), at(c)) <= 0)
          throw InputError(fmt::format(
              "{}: lines in a region are too close to each other at {} for a metric: move them apart",
              spec_.where, show_point(at(a))));
      }
    fine.triangle_region.assign(fine.triangles.size(), 0);
    fine.curves.resize(domain_.pieces.size());
    for (int p = 0; p < std::ssize(domain_.pieces); ++p) {
      const DomainPiece& piece = domain_.pieces[p];
      int from = piece.ends[0];
      double t = piece.from;
      for (std::size_t i = 0; i <= piece.nodes.size(); ++i) {
        const bool is_last = i == piece.nodes.size();
        const int to = is_last ? piece.ends[1] : piece.nodes[i];
        const double next = is_last ? piece.to : piece.interior[i];
        add_segment(p, from, to, t, next);
        fine.lines.push_back({from, to});
        fine.line_curve.push_back(p);
        from = to;
        t = next;
      }
    }
  }

  Vec2 at(int node) const { return flat(model_.fine.points[node]); }
  void add_segment(int piece, int a, int b, double ta, double tb) {
    segments_[key_of(a, b)] = {piece, {a, b}, {ta, tb}};
  }

  /// The metric as it is given at points, checked.
  std::vector<Tensor2> given_at(std::span<const Vec2> points) const {
    std::vector<Tensor2> metric(points.size());
    located(spec_.where, [&] { function_(points, metric); });
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Tensor2& m = metric[i];
      if (m.xx > 0 && m.yy > 0 && determinant(m) > 0 &&
          is_metric(spec_.limits.aspect > 0 ? limited(m, {.aspect = spec_.limits.aspect}) : m))
        continue;
      throw InputError(fmt::format(
          "{}: the metric is [{:.6g}, {:.6g}, {:.6g}] (m11, m12, m22) at {}: expected a finite, positive "
          "definite tensor. Its lengths may differ by a factor below {:g}, or give a largest aspect",
          spec_.where, m.xx, m.xy, m.yy, show_point(points[i]), kMostAspect));
    }
    return metric;
  }

  /// At the points that have none yet.
  void sample() {
    std::vector<Vec2> points;
    for (std::size_t i = given_.size(); i < model_.fine.points.size(); ++i)
      points.push_back(at(static_cast<int>(i)));
    const std::vector<Tensor2> metric = given_at(points);
    given_.insert(given_.end(), metric.begin(), metric.end());
  }

  /// Makes the metric from the given one: scaled to the complexity, within the limits, graded.
  void update_metric() {
    if (spec_.complexity > 0 && complexity_ > 0)
      scale_ *= std::clamp(spec_.complexity / complexity_, 0.25, 4.0);
    metric_.clear();
    for (const Tensor2& m : given_) metric_.push_back(within_limits(m));
    std::vector<char> is_less(metric_.size(), 0);
    shortened_ = {};
    follow_bends(is_less);
    follow_curves(is_less);
    // Demands of bends must not jump.
    if (spec_.gradation > 1)
      grade(spec_.gradation, std::vector<char>(metric_.size(), 1));
    else if (std::ranges::find(is_less, 1) != is_less.end())
      grade(kBendGradation, is_less);
    complexity_ = 0;
    for (const auto& [a, b, c] : model_.fine.triangles)
      complexity_ +=
          cross(at(b) - at(a), at(c) - at(a)) / 2 *
          std::pow(determinant(metric_[a]) * determinant(metric_[b]) * determinant(metric_[c]), 1.0 / 6);
    const double asked = spec_.complexity > 0 ? spec_.complexity : complexity_;
    if (!(asked <= static_cast<double>(max_elements_)))
      throw InputError(
          fmt::format("{}: the metric asks for about {:.3g} quads, more than the {} that are "
                      "allowed (max-elements) [too-many-quads]",
                      spec_.where, asked, max_elements_));
  }
  Tensor2 within_limits(const Tensor2& m) const { return limited(times(scale_, m), spec_.limits); }
  bool has_no_directions() const {
    return std::ranges::all_of(given_, [&](const Tensor2& m) {
      const MetricAxes axes = axes_of(within_limits(m));
      return std::log(axes.h2 / axes.h1) < kIsotropic;
    });
  }
  bool is_at_complexity() const {
    return !(spec_.complexity > 0) || std::abs(complexity_ / spec_.complexity - 1) < kNearComplexity;
  }

  /// The longest straight side along a line of that curvature.
  static double longest_along(double curvature, double across) {
    return std::sqrt(8 * kMostSagitta * across / curvature);
  }

  void note_shortened(const ShortenedLength& length) {
    if (shortened_.to == 0 || length.from * shortened_.to > shortened_.from * length.to) shortened_ = length;
  }

  /// The same where the metric's own directions bend: its larger lengths become less.
  void follow_bends(std::vector<char>& is_less) {
    std::vector<double> bend(metric_.size(), 0);
    std::vector<MetricAxes> axes;
    for (const Tensor2& m : metric_) axes.push_back(axes_of(m));
    for (const auto& v : model_.fine.triangles) {
      if (std::ranges::any_of(v, [&](int i) { return axes[i].h2 < kStretched * axes[i].h1; })) continue;
      std::array<double, 3> turn;
      for (int k = 0; k < 3; ++k)
        turn[k] = std::remainder(axes[v[k]].theta - axes[v[0]].theta, std::numbers::pi);
      // More is no bend: the lengths along both axes change places.
      if (std::ranges::any_of(turn, [](double a) { return std::abs(a) > std::numbers::pi / 4; })) continue;
      const Vec2 change = slope({at(v[0]), at(v[1]), at(v[2])}, turn);
      for (const int i : v) {
        const Vec2 along{-std::sin(axes[i].theta), std::cos(axes[i].theta)};
        bend[i] = std::max(bend[i], std::abs(dot(change, along)));
      }
    }
    for (std::size_t i = 0; i < bend.size(); ++i) {
      MetricAxes& a = axes[i];
      if (!(bend[i] > 0) || a.h2 <= longest_along(bend[i], a.h1)) continue;
      const double from = std::exchange(a.h2, std::max(longest_along(bend[i], a.h1), a.h1));
      note_shortened({at(static_cast<int>(i)), from, a.h2});
      metric_[i] = tensor_of(a);
      is_less[i] = 1;
    }
  }

  /// Straight sides along a curve are short enough for the lengths across it.
  void follow_curves(std::vector<char>& is_less) {
    std::vector<std::array<int, 2>> beside(model_.fine.points.size(), {-1, -1});
    for (const DomainPiece& piece : domain_.pieces)
      for (const int end : piece.ends) beside[end] = {-2, -2};
    for (const auto& line : model_.fine.lines)
      for (const int k : {0, 1})
        if (int* free = std::ranges::find(beside[line[k]], -1); free != beside[line[k]].end())
          *free = line[1 - k];
    for (int i = 0; i < std::ssize(beside); ++i) {
      if (beside[i][1] < 0) continue;
      const Vec2 in = at(i) - at(beside[i][0]), out = at(beside[i][1]) - at(i);
      const double turn = std::abs(std::atan2(cross(in, out), dot(in, out)));
      if (!(turn > 0)) continue;
      const double curvature = 2 * turn / (norm(in) + norm(out));
      Vec2 along = (1 / norm(in)) * in + (1 / norm(out)) * out;
      along = (1 / norm(along)) * along;
      const Vec2 across = perp(along);
      const double most = longest_along(curvature, 1 / std::sqrt(product(across, metric_[i], across)));
      const double from = 1 / std::sqrt(product(along, metric_[i], along));
      if (from <= most) continue;
      note_shortened({at(i), from, most});
      metric_[i] =
          intersection(metric_[i], tensor_of({most, most * kMostAspect / 10, std::atan2(along.y, along.x)}));
      is_less[i] = 1;
    }
  }

  /// Each sweep goes on from what the one before has changed.
  void grade(double gradation, std::vector<char> is_new) {
    std::vector<std::array<int, 2>> edges = all_edges();
    for (int sweep = 0; sweep < kGradationSweeps; ++sweep) {
      const std::vector<char> was_new = std::exchange(is_new, std::vector<char>(metric_.size(), 0));
      bool is_changed = false;
      for (const auto& [a, b] : edges)
        for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
          if (was_new[from] + is_new[from] == 0) continue;
          const double length = metric_length(at(to) - at(from), metric_[from], metric_[to]);
          const Tensor2 most = grown(metric_[from], length, gradation);
          if (is_finer(metric_[to], times(1 - kGraded, most))) continue;
          metric_[to] = intersection(metric_[to], most);
          is_new[to] = 1;
          is_changed = true;
        }
      if (!is_changed) return;
      std::ranges::reverse(edges);
    }
  }

  std::vector<std::array<int, 2>> all_edges() const {
    std::vector<std::array<int, 2>> edges;
    for (const auto& v : model_.fine.triangles)
      for (int k = 0; k < 3; ++k)
        edges.push_back({std::min(v[k], v[(k + 1) % 3]), std::max(v[k], v[(k + 1) % 3])});
    sort_unique(edges);
    return edges;
  }

  double sag(const CurveSegment& s) const {
    const Vec2 middle = domain_.pieces[s.piece].shape->point((s.t[0] + s.t[1]) / 2);
    const Vec2 chord = at(s.nodes[1]) - at(s.nodes[0]);
    return std::abs(cross(middle - at(s.nodes[0]), chord)) / dot(chord, chord);
  }

  struct Split {
    double length;
    int a, b;
    Vec2 middle;
  };

  /// The sides to be halved, longest first.
  std::vector<Split> splits() {
    std::vector<Split> found, unknown;
    std::vector<Vec2> middles;
    for (const auto& [a, b] : all_edges()) {
      const auto segment = segments_.find(key_of(a, b));
      const Vec2 d = at(b) - at(a);
      Split split{metric_length(d, metric_[a], metric_[b]), a, b, 0.5 * (at(a) + at(b))};
      bool is_long = norm(d) > longest_ || split.length > kLongest ||
                     (split.length > kShortest && difference(metric_[a], metric_[b]) > kSteepest);
      if (segment != segments_.end()) {
        const CurveSegment& s = segment->second;
        split.middle = domain_.pieces[s.piece].shape->point((s.t[0] + s.t[1]) / 2);
        is_long = is_long || sag(s) > kChordSag;
      }
      if (is_long)
        found.push_back(split);
      else if (probed_.insert(key_of(a, b)).second)
        unknown.push_back(split), middles.push_back(split.middle);
    }
    // This is the given metric at the middles.
    const std::vector<Tensor2> between = given_at(middles);
    for (std::size_t i = 0; i < unknown.size(); ++i) {
      const auto& [length, a, b, middle] = unknown[i];
      const Tensor2 here = within_limits(between[i]);
      const Tensor2 expected =
          log_mean(std::array{within_limits(given_[a]), within_limits(given_[b])}, std::array{0.5, 0.5});
      if (metric_length(at(b) - at(a), here, here) > kShortest && difference(here, expected) > kSteepest)
        found.push_back(unknown[i]);
    }
    std::ranges::sort(found, [](const Split& p, const Split& q) {
      return std::tuple(-p.length, p.a, p.b) < std::tuple(-q.length, q.a, q.b);
    });
    return found;
  }

  /// A new point inside of the circle over a side on a curve would make slivers: that side is halved before.
  Split segment_instead(const SurfaceEditor& editor, const Split& split) const {
    if (segments_.contains(key_of(split.a, split.b))) return split;
    for (const int t : editor.triangles_on(split.a, split.b)) {
      const int tip = opposite(t, split.a, split.b);
      if (tip >= std::ssize(metric_)) continue;  // made in this pass: the side waits for the next
      for (const int end : {split.a, split.b}) {
        const auto segment = segments_.find(key_of(end, tip));
        if (segment == segments_.end() ||
            product(at(end) - split.middle, metric_[end], at(tip) - split.middle) > 0)
          continue;
        const CurveSegment& s = segment->second;
        return {metric_length(at(tip) - at(end), metric_[end], metric_[tip]), s.nodes[0], s.nodes[1],
                domain_.pieces[s.piece].shape->point((s.t[0] + s.t[1]) / 2)};
      }
    }
    return split;
  }

  /// Halves sides, one a triangle; returns how many.
  int refine(SurfaceEditor& editor) {
    std::vector<char> is_taken(model_.fine.triangles.size(), 0);
    std::vector<std::array<int, 3>> made;  // ends and the new node
    for (const Split& wanted : splits()) {
      const Split split = segment_instead(editor, wanted);
      if (split.length < kShortest / 2) continue;
      const std::vector<int> beside = editor.triangles_on(split.a, split.b);
      if (beside.empty() ||  // halved in place of another
          std::ranges::any_of(beside, [&](int t) { return t >= std::ssize(is_taken) || is_taken[t] != 0; }) ||
          !std::ranges::all_of(beside, [&](int t) { return stays_upright(t, split); }))
        continue;
      for (const int t : beside) is_taken[t] = 1;
      const int node = editor.split_edge(split.a, split.b, {split.middle.x, split.middle.y, 0});
      made.push_back({split.a, split.b, node});
      const auto segment = segments_.find(key_of(split.a, split.b));
      if (segment == segments_.end()) continue;
      const CurveSegment s = segment->second;
      segments_.erase(segment);
      const double t = (s.t[0] + s.t[1]) / 2;
      add_segment(s.piece, s.nodes[0], node, s.t[0], t);
      add_segment(s.piece, node, s.nodes[1], t, s.t[1]);
    }
    if (model_.fine.points.size() > kMostPoints)
      throw InputError(
          fmt::format("{}: the metric changes too fast to be followed by {} points: a gradation or "
                      "a larger least length helps [metric-too-fast]",
                      spec_.where, kMostPoints));
    sample();
    for (const auto& [a, b, node] : made)
      metric_.push_back(intersection(log_mean(std::array{metric_[a], metric_[b]}, std::array{0.5, 0.5}),
                                     within_limits(given_[node])));
    std::vector<std::array<int, 2>> edges;
    for (const auto& [a, b, node] : made)
      for (const int t : editor.triangles_at(node))
        for (int k = 0; k < 3; ++k) {
          const auto& v = model_.fine.triangles[t];
          edges.push_back({v[k], v[(k + 1) % 3]});
        }
    flip(editor, std::move(edges));
    return static_cast<int>(made.size());
  }

  /// Whether both halves of a triangle have area.
  bool stays_upright(int triangle, const Split& split) const {
    for (const int end : {split.a, split.b}) {
      std::array<Vec2, 3> x;
      for (int k = 0; k < 3; ++k) {
        const int v = model_.fine.triangles[triangle][k];
        x[k] = v == end ? split.middle : at(v);
      }
      if (orient2d(x[0], x[1], x[2]) <= 0) return false;
    }
    return true;
  }

  void flip_all(SurfaceEditor& editor) { flip(editor, all_edges()); }

  /// Flips edges that are not Delaunay in the metric, and those around them.
  void flip(SurfaceEditor& editor, std::vector<std::array<int, 2>> edges) {
    std::ranges::reverse(edges);
    std::vector<int> beside;
    for (std::size_t left = 20 * edges.size() + 1000; !edges.empty() && left > 0; --left) {
      const auto [a, b] = edges.back();
      edges.pop_back();
      if (segments_.contains(key_of(a, b))) continue;
      editor.find_triangles_on(a, b, beside);
      if (beside.size() != 2) continue;
      const int c = opposite(beside[0], a, b), d = opposite(beside[1], a, b);
      if (!is_better_turned(a, b, c, d) || !editor.flip_edge(a, b)) continue;
      for (const auto& edge : {std::array{a, c}, {a, d}, {b, c}, {b, d}}) edges.push_back(edge);
    }
  }

  int opposite(int triangle, int a, int b) const {
    const auto& v = model_.fine.triangles[triangle];
    return v[0] + v[1] + v[2] - a - b;
  }

  bool is_better_turned(int a, int b, int c, int d) const {
    Tensor2 m{0, 0, 0};
    for (const int i : {a, b, c, d}) m = {m.xx + metric_[i].xx, m.xy + metric_[i].xy, m.yy + metric_[i].yy};
    const auto cotangent = [&](int tip) {
      const Vec2 p = at(a) - at(tip), q = at(b) - at(tip);
      return product(p, m, q) / (std::abs(cross(p, q)) * std::sqrt(determinant(m)));
    };
    if (!(cotangent(c) + cotangent(d) < kFlip)) return false;
    const int side = orient2d(at(c), at(d), at(a));
    return side != 0 && orient2d(at(c), at(d), at(b)) == -side;
  }

  const PlanarDomain& domain_;
  const MetricFunction& function_;
  const MetricSpec& spec_;
  long long max_elements_;
  double longest_ = 0;
  ShortenedLength shortened_;
  double scale_ = 1;       ///< of the tensors
  double complexity_ = 0;  ///< of `metric_`
  SurfaceModel model_;
  std::vector<Tensor2> given_, metric_;                   ///< at points
  std::unordered_map<long long, CurveSegment> segments_;  ///< by edge
  std::unordered_set<long long> probed_;                  ///< edges; only looked up
};

}  // namespace

MetricMesh resolve_metric(const PlanarDomain& domain, const MetricFunction& metric, const MetricSpec& spec,
                          long long max_elements) {
  return MetricMesher(domain, metric, spec, max_elements).run();
}

}  // namespace delquad
