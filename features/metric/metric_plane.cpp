// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/metric/metric_plane.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "algorithms/fields/size_by.h"
#include "base/located.h"
#include "base/parallel.h"
#include "base/segment.h"
#include "base/text.h"
#include "delquad/error.h"
#include "features/curves/mesh_planar_curves.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/model_kind.h"
#include "geometry/planar/curve_span.h"
#include "geometry/planar/model_chain.h"
#include "geometry/surface/conformal_maps.h"

namespace delquad {
namespace {

/// Edges of curves before they are resolved, in diagonals of the domain.
constexpr double kCoarseEdge = 1.0 / 100;
/// Lengths that are shortened by more than this factor are told of, where no complexity scales them anyway.
constexpr double kReportedFactor = 1.2;
/// Maps with a larger FlatQuality::sigma_95 are told of.
constexpr double kPoorSigma = 1.3;
/// Between the parts of a domain that are laid flat each by itself, in their widths.
constexpr double kApart = 0.1;

/// How much crosses are drawn to axes whose lengths differ by a factor of e, per unit area, against the
/// change of crosses.
constexpr double kPull = 0.2;

/// A curve in the flat plane, straight between samples.
class FlatCurve final : public Curve {
 public:
  struct Sample {
    double t;
    Vec2 at;
  };
  FlatCurve(std::vector<Sample> samples, std::vector<double> fixed)
      : samples_(std::move(samples)), fixed_(std::move(fixed)) {}
  Vec2 point(double t) const override {
    const auto after = std::upper_bound(samples_.begin() + 1, samples_.end() - 1, t,
                                        [](double x, const Sample& s) { return x < s.t; });
    const Sample &a = *(after - 1), &b = *after;
    const double part = (t - a.t) / (b.t - a.t);
    if (part == 1) return b.at;
    return a.at + part * (b.at - a.at);
  }
  std::vector<double> fixed_parameters() const override { return fixed_; }

 private:
  std::vector<Sample> samples_;
  std::vector<double> fixed_;
};

void check(const MetricSpec& metric) {
  const auto is_bad = [](double x) { return !(x >= 0) || !std::isfinite(x); };
  const MetricLimits& limits = metric.limits;
  if (is_bad(limits.min) || is_bad(limits.max) || is_bad(limits.aspect) || is_bad(metric.complexity))
    throw InputError(
        fmt::format("{}: min {}, max {}, aspect {}, complexity {}: expected finite numbers above 0, or "
                    "0 for none",
                    metric.where, limits.min, limits.max, limits.aspect, metric.complexity));
  if (limits.max > 0 && limits.min > limits.max)
    throw InputError(fmt::format("{}: min {} is above max {}", metric.where, limits.min, limits.max));
  if (limits.aspect > 0 && limits.aspect < 1)
    throw InputError(fmt::format("{}: aspect {}: expected at least 1", metric.where, limits.aspect));
  if (metric.gradation != 0 && !(metric.gradation > 1 && std::isfinite(metric.gradation)))
    throw InputError(fmt::format("{}: gradation {}: expected a factor above 1, or 0 for none", metric.where,
                                 metric.gradation));
}

[[noreturn]] void refuse_with_metric(const MeshProblem& problem, const std::string& what,
                                     const std::string& where) {
  throw InputError(fmt::format("{}: {} not go with a metric ({}) yet [not-with-a-metric]", where, what,
                               problem.metric.where));
}

}  // namespace

void check_metric(const MeshProblem& problem) {
  check(problem.metric);
  const auto refuse = [&](const std::string& what, const std::string& where) {
    refuse_with_metric(problem, what, where);
  };
  if (kind_of(problem.model).kept != nullptr) refuse("kept lines and given meshes do", problem.where);
  if (!problem.layers.empty()) refuse("layers do", problem.layers[0].where);
  if (!problem.washers.empty()) refuse("rows around holes do", problem.washers[0].where);
  if (!problem.fillet_rows.empty()) refuse("rows across fillets do", problem.fillet_rows[0].where);
  if (!problem.periodic.empty()) refuse("periodic sides do", problem.periodic[0].where);
  if (problem.symmetry.automatic || !problem.symmetry.planes.empty())
    refuse("planes of symmetry do", problem.symmetry.where);
  if (!problem.criteria.empty()) refuse("criteria do", problem.criteria.where);
  const SizeSpec& size = problem.size;
  if (size.field || size.function || size.from_boundary || !size.sources.empty() || !size.named.empty() ||
      size.gradation > 0 || size.max > 0 || size.curvature > 0 || size.min > 0)
    refuse("a size does", size.where);
  const auto kind = problem.cross.kind.value_or(CrossKind::kBoundary);
  if (kind == CrossKind::kField || kind == CrossKind::kGradient)
    refuse("given directions and directions of a gradient do", problem.cross.where);
  const auto* model = std::get_if<PlanarModel>(&problem.model);
  const MetricSpec& metric = problem.metric;
  if (model == nullptr ? metric.in_space == nullptr && !(metric.chord > 0) : metric.function == nullptr)
    throw InputError(metric.where +
                     (model == nullptr
                          ? ": a metric of surfaces has tensors in space, six formulas, a file, or a chord"
                          : ": a metric of planar domains has tensors of the plane: a chord and tensors in "
                            "space are for surfaces"));
  for (const EmbeddedLine& line : problem.surface.embed)
    if (line.is_crack) refuse("cracks do", line.where);
  if (model == nullptr) return;
  for (const ModelCurve& curve : model->curves)
    if (curve.is_crack) refuse("cracks do", curve.where);
}

CrossPull pull_to(Vec2 along, const MetricAxes& axes) {
  const double stretch = std::log(axes.h2 / axes.h1);
  if (!(norm(along) > 0)) return {{0, 0}, 0};
  return {Cross::along(along), kPull * stretch * stretch};
}

namespace {

/// The domain in one piece for each connected part, measured by the metric.
std::vector<Chart> metric_charts(const MetricMesh& made, const MeshProblem& problem) {
  Mesh whole;
  whole.points = made.fine.points;
  whole.triangles = made.fine.triangles;
  whole.triangle_region.assign(whole.triangles.size(), 0);
  whole.regions.resize(1);
  for_each_edge(sorted_half_edges(whole), [&](std::span<const HalfEdge> edge) {
    if (edge.size() == 1) whole.lines.push_back({edge[0].lo, edge[0].hi});
  });
  std::vector<Chart> charts = extract_charts(whole, std::vector<char>(whole.triangles.size(), 1));
  std::vector<char> is_seen(whole.points.size(), 0);
  for (Chart& chart : charts) {
    for (const int node : chart.fine_node)
      if (std::exchange(is_seen[node], 1) != 0)
        throw InputError(
            fmt::format("{}: the domain hangs together by a single point at {}, which does not go with a "
                        "metric yet [not-with-a-metric]",
                        problem.metric.where, show_point(whole.points[node])));
    for (const auto& v : chart.triangles) {
      auto& sides = chart.sides.emplace_back();
      for (int k = 0; k < 3; ++k) {
        const int a = chart.fine_node[v[(k + 1) % 3]], b = chart.fine_node[v[(k + 2) % 3]];
        const Vec3 d = whole.points[b] - whole.points[a];
        sides[k] = metric_length({d.x, d.y}, made.metric[a], made.metric[b]);
      }
    }
  }
  return charts;
}

/// The disk that a chart is whose holes are closed by flat ones of their circumference: maps of it are
/// conformal maps of the chart.
Chart without_holes(Chart chart) {
  for (std::size_t hole = 1; hole < chart.loops.size(); ++hole) {
    const std::vector<int>& loop = chart.loops[hole];
    const int n = static_cast<int>(loop.size()), apex = static_cast<int>(chart.points.size());
    const int first = static_cast<int>(chart.triangles.size());
    std::map<std::array<int, 2>, std::array<int, 2>> side_of;  // triangle, and the corner opposite
    for (int t = 0; t < first; ++t)
      for (int k = 0; k < 3; ++k)
        if (chart.neighbours[t][k] < 0)
          side_of[{chart.triangles[t][(k + 1) % 3], chart.triangles[t][(k + 2) % 3]}] = {t, k};
    double around = 0;
    for (int i = 0; i < n; ++i) {
      const auto [t, k] = side_of.at({loop[i], loop[(i + 1) % n]});
      around += chart.sides[t][k];
    }
    const double radius = around / (2 * std::numbers::pi);
    for (int i = 0; i < n; ++i) {
      const auto [t, k] = side_of.at({loop[i], loop[(i + 1) % n]});
      chart.neighbours[t][k] = first + i;
      chart.triangles.push_back({loop[(i + 1) % n], loop[i], apex});
      chart.neighbours.push_back({first + (i + n - 1) % n, first + (i + 1) % n, t});
      chart.sides.push_back({radius, radius, chart.sides[t][k]});
    }
    chart.points.push_back(chart.points[loop[0]]);
  }
  chart.n_boundary = static_cast<int>(chart.loops[0].size());
  chart.loops.resize(1);
  return chart;
}

ConformalMap flatten_chart(const Chart& chart, const MeshProblem& problem) {
  std::optional<ConformalMap> map;
  if (chart.loops.size() == 1) map = checked_map(chart, boundary_first_map(chart), "boundary-first");
  if (!map) map = checked_map(chart, spectral_map(chart), "spectral");
  const Chart disk = map ? Chart() : without_holes(chart);
  for (const bool is_convex : {false, true}) {
    if (map) break;
    std::vector<Vec2> flat = is_convex ? convex_map(disk) : boundary_first_map(disk);
    flat.resize(chart.points.size());
    map = checked_map(chart, std::move(flat), is_convex ? "convex" : "boundary-first");
  }
  if (!map)
    throw InputError(fmt::format(
        "{}: the metric bends the domain so much that it cannot be laid flat in one piece. Divide the "
        "domain, or give a metric that changes less or a gradation nearer to 1 [metric-too-fast]",
        problem.metric.where));
  return *std::move(map);
}

/// The flat plane and, of each node of the mesh, the vertex there.
std::pair<MetricPlane, std::vector<int>> lay_flat(const MetricMesh& made, const PlanarDomain& domain,
                                                  const MeshProblem& problem) {
  const std::vector<Chart> charts = metric_charts(made, problem);
  TriPatch flat, plane;
  std::vector<Tensor2> metric;
  std::vector<double> size;
  std::vector<int> vertex(made.fine.points.size());
  FlatQuality worst;
  double shift = 0;
  // Boundary points of all parts come first.
  std::vector<ConformalMap> maps;
  for (const Chart& chart : charts) {
    maps.push_back(flatten_chart(chart, problem));
    flat.n_boundary += chart.n_boundary;
    if (maps.back().quality.sigma_95 > worst.sigma_95) worst = maps.back().quality;
  }
  int next[2] = {0, flat.n_boundary};
  flat.points.resize(made.fine.points.size());
  plane.points.resize(flat.points.size());
  metric.resize(flat.points.size());
  size.resize(flat.points.size());
  for (std::size_t c = 0; c < charts.size(); ++c) {
    const Chart& chart = charts[c];
    const auto box = Box<Vec2>::around(std::span<const Vec2>(maps[c].flat));
    const Vec2 move{shift - box.low.x, -box.low.y};
    shift += (1 + kApart) * (box.high.x - box.low.x);
    std::vector<double> area(chart.points.size(), 0), flat_area(chart.points.size(), 0);
    const std::vector<double> areas = triangle_areas(chart);
    const int first = static_cast<int>(flat.triangles.size());
    std::vector<int> number;
    for (int v = 0; v < std::ssize(chart.points); ++v) {
      number.push_back(next[v < chart.n_boundary ? 0 : 1]++);
      const int node = chart.fine_node[v];
      vertex[node] = number[v];
      flat.points[number[v]] = maps[c].flat[v] + move;
      plane.points[number[v]] = {chart.points[v].x, chart.points[v].y};
      metric[number[v]] = made.metric[node];
    }
    for (std::size_t t = 0; t < chart.triangles.size(); ++t) {
      const auto& v = chart.triangles[t];
      const auto& u = maps[c].flat;
      flat.triangles.push_back({number[v[0]], number[v[1]], number[v[2]]});
      auto& neighbours = flat.neighbours.emplace_back(chart.neighbours[t]);
      for (int& n : neighbours) n = n < 0 ? -1 : n + first;
      for (const int i : v) {
        area[i] += areas[t];
        flat_area[i] += cross(u[v[1]] - u[v[0]], u[v[2]] - u[v[0]]) / 2;
      }
    }
    for (std::size_t v = 0; v < area.size(); ++v) size[number[v]] = std::sqrt(flat_area[v] / area[v]);
  }
  plane.triangles = flat.triangles;
  plane.neighbours = flat.neighbours;
  plane.n_boundary = flat.n_boundary;
  std::vector<MetricPlane::Segment> segments;
  std::vector<Box<Vec2>> boxes;
  for (const CurveSegment& s : made.segments) {
    const int a = vertex[s.nodes[0]], b = vertex[s.nodes[1]];
    segments.push_back({domain.pieces[s.piece].shape, s.t, {a, b}});
    boxes.push_back(Box<Vec2>::around({flat.points[a], flat.points[b]}));
  }
  MetricPlane result{BackgroundMesh(std::move(flat)),
                     BackgroundMesh(std::move(plane)),
                     std::move(metric),
                     std::move(size),
                     std::move(segments),
                     BoxTree<Vec2>(boxes),
                     {},
                     {},
                     worst};
  return {std::move(result), std::move(vertex)};
}

/// Samples of a model's curve from the segments that lie on it. Where curves lie on each other these are of
/// one of them, and have other parameters here.
class CurveSamples {
 public:
  CurveSamples(const PlanarModel& model, const MetricMesh& made, const PlanarDomain& domain)
      : model_(model), made_(made), domain_(domain), of_piece_(domain.pieces.size()) {
    for (const CurveSegment& s : made.segments) of_piece_[s.piece].push_back(&s);
    std::map<std::array<int, 2>, int> curve_of;  // of lines
    for (std::size_t l = 0; l < domain.boundary.lines.size(); ++l) {
      const auto [a, b] = domain.boundary.lines[l];
      curve_of[{std::min(a, b), std::max(a, b)}] = domain.boundary.line_curve[l];
    }
    for (const DomainPiece& piece : domain.pieces) {
      const int b = piece.nodes.empty() ? piece.ends[1] : piece.nodes[0];
      const auto line = curve_of.find({std::min(piece.ends[0], b), std::max(piece.ends[0], b)});
      curve_.push_back(line == curve_of.end() ? -1 : line->second);
    }
  }

  std::vector<FlatCurve::Sample> of(int curve, const MetricPlane& plane,
                                    const std::vector<int>& vertex) const {
    const Curve& shape = *model_.curves[curve].shape;
    std::optional<CurveSpan> span;
    std::vector<FlatCurve::Sample> samples;
    const auto add = [&](double t, int node) {
      samples.push_back({t, plane.flat.triangles().points[vertex[node]]});
    };
    for (std::size_t p = 0; p < of_piece_.size(); ++p) {
      if (curve_[p] < 0) continue;
      const auto& lies_there = domain_.model_curves[curve_[p]];
      if (std::ranges::find(lies_there, curve) == lies_there.end()) continue;
      const bool is_own = domain_.pieces[p].shape == model_.curves[curve].shape;
      for (const CurveSegment* s : of_piece_[p]) {
        std::array<double, 2> t = s->t;
        if (!is_own) {
          if (!span) span.emplace(shape, 0, 1);
          for (int k = 0; k < 2; ++k) {
            const Vec3& x = made_.fine.points[s->nodes[k]];
            t[k] = span->nearest({x.x, x.y}).t;
          }
          // Where a closed curve begins it ends.
          for (int k = 0; k < 2; ++k)
            if (std::abs(t[k] - t[1 - k]) > 0.5) t[k] = t[k] < 0.5 ? 1 : 0;
        }
        for (int k = 0; k < 2; ++k) add(t[k], s->nodes[k]);
      }
    }
    std::ranges::sort(samples, {}, &FlatCurve::Sample::t);
    const auto same = std::ranges::unique(samples, [](const auto& a, const auto& b) {
      return a.t == b.t || (a.at == b.at && b.t - a.t < kSameParameter);
    });
    samples.erase(same.begin(), same.end());
    if (samples.size() < 2 || samples.front().t > kSameParameter || samples.back().t < 1 - kSameParameter)
      throw InputError(curve_label(model_, curve) + ": it cannot be followed by a metric");
    samples.front().t = 0;
    samples.back().t = 1;
    return samples;
  }

 private:
  /// Difference of equal parameters after the search for the nearest point.
  static constexpr double kSameParameter = 1e-9;

  const PlanarModel& model_;
  const MetricMesh& made_;
  const PlanarDomain& domain_;
  std::vector<std::vector<const CurveSegment*>> of_piece_;
  std::vector<int> curve_;  ///< of the mesh, of each piece; -1: none
};

/// The problem by the size that a metric without directions is: as its formulas have it, or, where there are
/// none, on the triangulation.
MeshProblem by_its_size(MeshProblem problem, MetricMesh made) {
  const MetricSpec spec = std::exchange(problem.metric, {});
  if (problem.cross.kind == CrossKind::kMetric) problem.cross.kind = CrossKind::kSizeAware;
  problem.size.where = spec.where;
  if (spec.tensor.empty() && spec.sizes.empty()) {
    std::vector<double> size;
    for (const Tensor2& m : made.metric) size.push_back(axes_of(m).h1);
    problem.size.field = make_nodal_size(made.fine, std::move(size));
  } else {
    problem.size.field = size_by([spec, scale = made.scale](const Vec3& x, int&) {
      Tensor2 m;
      const Vec2 at{x.x, x.y};
      located(spec.where, [&] { spec.function({&at, 1}, {&m, 1}); });
      return 1 / std::sqrt(limited(times(scale, m), spec.limits).xx);
    });
    // 1 + l log(gradation) by the length l in the metric is that slope.
    if (spec.gradation > 1) problem.size.gradation = std::log(spec.gradation);
  }
  return problem;
}

Vec2 by_weights(const TriPatch& from, int triangle, Vec2 at, const TriPatch& to) {
  const auto& [i, j, k] = from.triangles[triangle];
  const Vec2 a = from.points[i], ab = from.points[j] - a, ac = from.points[k] - a;
  const double area = cross(ab, ac), b = cross(at - a, ac) / area, c = cross(ab, at - a) / area;
  return to.points[i] + b * (to.points[j] - to.points[i]) + c * (to.points[k] - to.points[i]);
}

}  // namespace

Vec2 MetricPlane::to_plane(Vec2 u, int& hint) const {
  u = turn.back(u);
  return by_weights(flat.triangles(), flat.locate(u, hint).triangle, u, plane.triangles());
}

Vec2 MetricPlane::to_flat(Vec2 x, int& hint) const {
  return turn(by_weights(plane.triangles(), plane.locate(x, hint).triangle, x, flat.triangles()));
}

Vec2 MetricPlane::curve_to_plane(Vec2 u) const {
  u = turn.back(u);
  const Segment* nearest = nullptr;
  double part = 0, least2 = std::numeric_limits<double>::infinity();
  int first = -1;
  segment_tree.nearest(u, least2, [&](int i) {
    const auto& [from, to] = segments[i].vertices;
    const Vec2 a = flat.triangles().points[from], b = flat.triangles().points[to];
    const double t = nearest_part(u, a, b);
    const Vec2 d = a + t * (b - a) - u;
    if (dot(d, d) > least2 || (dot(d, d) == least2 && i > first)) return;
    nearest = &segments[i], first = i, part = t, least2 = dot(d, d);
  });
  return nearest->shape->point((1 - part) * nearest->t[0] + part * nearest->t[1]);
}

Vec3 MetricPlane::to_plane(const Vec3& u) const {
  int hint = -1;
  const Vec2 x = to_plane(Vec2{u.x, u.y}, hint);
  return {x.x, x.y, 0};
}

Vec3 MetricPlane::to_flat(const Vec3& x) const {
  int hint = -1;
  const Vec2 u = to_flat(Vec2{x.x, x.y}, hint);
  return {u.x, u.y, 0};
}

CrossPull MetricPlane::pull_at(Vec2 u, int& hint) const {
  const auto [t, b] = flat.locate(turn.back(u), hint);
  const auto& v = flat.triangles().triangles[t];
  const MetricAxes axes = axes_of(log_mean(std::array{metric[v[0]], metric[v[1]], metric[v[2]]}, b));
  const Vec2 x = plane.triangles().points[v[0]];
  const Vec2 e{std::cos(axes.theta), std::sin(axes.theta)};
  const Vec2 along =
      by_weights(plane.triangles(), t, x + axes.h1 * e, flat.triangles()) - flat.triangles().points[v[0]];
  return pull_to(turn(along), axes);
}

Tensor2 MetricPlane::metric_at(Vec2 x, int& hint) const {
  const auto [t, b] = plane.locate(x, hint);
  const auto& v = plane.triangles().triangles[t];
  return log_mean(std::array{metric[v[0]], metric[v[1]], metric[v[2]]}, b);
}

double MetricPlane::scale_of(const SizeField& other) const {
  int hint = -1;
  const Vec2 u = turn(flat.triangles().points[0]);
  return other.at({u.x, u.y, 0}, hint) / size[0];
}

MeshProblem in_metric_plane(MeshProblem problem, std::vector<Warning>& warnings) {
  const PlanarModel& model = std::get<PlanarModel>(problem.model);
  const Vec2 low = box_of(model, 64).low, high = box_of(model, 64).high;
  const double edge = kCoarseEdge * norm(high - low);
  if (!(problem.metric.limits.max > 0)) problem.metric.limits.max = norm(high - low);
  const PlanarDomain domain = make_domain(model, *make_constant_size(edge));
  MetricMesh made = resolve_metric(domain, problem.metric.function, problem.metric, problem.max_elements);
  if (made.is_isotropic) return by_its_size(std::move(problem), std::move(made));
  auto [plane, vertex] = lay_flat(made, domain, problem);
  PlanarModel flat = model;
  const CurveSamples samples(model, made, domain);
  for (int c = 0; c < std::ssize(flat.curves); ++c) {
    const std::shared_ptr<const Curve>& shape = model.curves[c].shape;
    flat.curves[c].shape =
        std::make_shared<FlatCurve>(samples.of(c, plane, vertex), shape->fixed_parameters());
    plane.true_curve[flat.curves[c].shape.get()] = shape;
  }
  int hint = -1;
  for (ModelPoint& point : flat.points) point.at = plane.to_flat(point.at, hint);
  if (problem.seed != 0) plane.turn = Rotation::by_seed(problem.seed);
  const auto shared = std::make_shared<const MetricPlane>(std::move(plane));
  problem.metric.plane = shared;
  problem.size.field = size_by([shared](const Vec3& u, int& near) {
    const auto [t, b] = shared->flat.locate({u.x, u.y}, near);
    const auto& v = shared->flat.triangles().triangles[t];
    return b[0] * shared->size[v[0]] + b[1] * shared->size[v[1]] + b[2] * shared->size[v[2]];
  });
  problem.size.where = problem.metric.where;
  problem.model = std::move(flat);
  if (const ShortenedLength& length = made.shortened;
      problem.metric.complexity == 0 && length.from > kReportedFactor * length.to)
    warnings.emplace_back(fmt::format(
        "{}: the metric is followed with shorter lengths where it bends, {:.3g} in place of {:.3g} at {}. "
        "Straight sides would stray there by more than a fifth of the length across",
        problem.metric.where, length.to, length.from, show_point(length.at)));
  if (const FlatQuality& quality = shared->quality; quality.sigma_95 > kPoorSigma)
    warnings.emplace_back(
        fmt::format("{}: the map to the flat plane of the metric distorts angles by {:.3g} in 5 % of the "
                    "domain: the metric changes faster than it is sampled. A gradation helps",
                    problem.metric.where, quality.sigma_95));
  return problem;
}

std::vector<std::vector<std::shared_ptr<const Curve>>> true_curves(
    const MetricPlane& plane, std::vector<std::vector<std::shared_ptr<const Curve>>> flat) {
  for (auto& shapes : flat) {
    std::erase_if(shapes, [&](const auto& shape) { return !plane.true_curve.contains(shape.get()); });
    for (auto& shape : shapes) shape = plane.true_curve.at(shape.get());
  }
  return flat;
}

void to_plane(const MetricPlane& plane, Mesh& mesh) {
  std::vector<char> on_line(mesh.points.size(), 0);
  for (const auto& line : mesh.lines)
    for (const int v : line) on_line[v] = 1;
  parallel_ranges(mesh.points.size(), [&](std::size_t begin, std::size_t end) {
    int hint = -1;
    for (std::size_t i = begin; i < end; ++i) {
      const Vec2 u{mesh.points[i].x, mesh.points[i].y};
      const Vec2 x = on_line[i] != 0 ? plane.curve_to_plane(u) : plane.to_plane(u, hint);
      mesh.points[i] = {x.x, x.y, 0};
    }
  });
}

int count_bad_quads(const MetricAt& metric, const std::string& label, const Mesh& mesh,
                    std::vector<Warning>& warnings) {
  const std::vector<double> etas = anisotropic_etas(mesh, metric);
  const auto bad = static_cast<int>(std::ranges::count_if(etas, [](double eta) { return eta < kBadEta; }));
  if (bad == 0) return 0;
  const auto worst = std::ranges::min_element(etas);
  Vec3 middle;
  for (const int v : mesh.quads[worst - etas.begin()]) middle = middle + 0.25 * mesh.points[v];
  warnings.emplace_back(
      fmt::format("{}: {} of {} quads are poor in the metric (an angle below 10 or above 170 degrees), the "
                  "worst at {} (eta {:.2g}). A gradation helps where the metric changes fast",
                  label, bad, etas.size(), show_point(middle), *worst));
  return bad;
}

}  // namespace delquad
