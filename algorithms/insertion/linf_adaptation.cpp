// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/insertion/linf_adaptation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "algorithms/insertion/vertex_fields.h"
#include "base/cancel.h"
#include "base/predicates.h"
#include "base/stopwatch.h"
#include "geometry/mesh/tri_topology.h"

namespace delquad {
namespace {

constexpr double kLongest = std::numbers::sqrt2, kShortest = 1 / kLongest;

class Adaptation {
 public:
  Adaptation(const TriPatch& tri, const CrossField& cross, const ParametricSize& size,
             const AdaptationOptions& options)
      : mesh_(tri), cross_(cross), size_(size), options_(options) {
    for (std::size_t i = 0; i < tri.points.size(); ++i) sample(static_cast<int>(i), VertexFields{});
  }

  TriPatch run(AdaptationSummary& s) {
    for (long long edits = mesh_.triangle_slots();
         edits > mesh_.triangle_slots() / kFew && s.sweeps < options_.max_sweeps; ++s.sweeps) {
      const long long splits = split_long(), collapses = collapse_short();
      const long long swaps = swap_edges();
      s.moves += move_vertices();
      s.splits += splits;
      s.collapses += collapses;
      s.swaps += swaps;
      edits = splits + collapses + swaps;
    }
    s.swaps += swap_edges();
    return mesh_.to_patch();
  }

 private:
  /// Edge with its length; a < b.
  struct Edge {
    double length;
    int a, b;
  };

  /// Samples the fields at vertex i. `near` is a copy, since it may lie in the list that grows here.
  void sample(int i, VertexFields near) {
    if (static_cast<std::size_t>(i) >= fields_.size()) fields_.resize(i + 1);
    fields_[i] = sample_fields(cross_, size_, mesh_.point(i), near);
  }

  /// Axes and length of a measure of vectors.
  struct Frame {
    Vec2 e;
    double delta;
    Vec2 of(Vec2 d) const { return (1 / delta) * Vec2{dot(e, d), ::delquad::cross(e, d)}; }
    Vec2 to_plane(Vec2 f) const { return delta * (f.x * e + f.y * perp(e)); }
  };
  /// Returns the mean frame at some vertices.
  template <std::size_t N>
  Frame frame_of(const std::array<int, N>& vertices) const {
    Cross sum = {0, 0};
    double delta = 0;
    for (const int i : vertices) {
      sum = sum + fields_[i].cross;
      delta += fields_[i].delta / N;
    }
    const double theta = sum.angle();
    return {{std::cos(theta), std::sin(theta)}, delta};
  }
  static double largest(Vec2 d) { return std::max(std::abs(d.x), std::abs(d.y)); }
  double length(int a, int b) const {
    return largest(frame_of(std::array{a, b}).of(mesh_.point(b) - mesh_.point(a)));
  }

  /// Returns 2 A / l^2 of a triangle in the frame; 0 if it is flat or inverted.
  double measure(const Frame& frame, int a, int b, int c) const {
    const Vec2 p = mesh_.point(a), q = mesh_.point(b), r = mesh_.point(c);
    if (orient2d(p, q, r) <= 0) return 0;
    const double longest =
        std::max({largest(frame.of(q - p)), largest(frame.of(r - q)), largest(frame.of(p - r))});
    return ::delquad::cross(q - p, r - p) / (frame.delta * frame.delta * longest * longest);
  }

  /// Returns inner edges whose length is `wanted`, with their vertices.
  template <class Wanted>
  std::vector<Edge> inner_edges(Wanted wanted) const {
    std::vector<Edge> edges;
    for (int t = 0; t < mesh_.triangle_slots(); ++t) {
      if (!mesh_.alive(t)) continue;
      for (int k = 0; k < 3; ++k) {
        if (mesh_.across(t, k) < t) continue;
        const int a = mesh_.vertex(t, k + 1), b = mesh_.vertex(t, k + 2);
        if (const double l = length(a, b); wanted(l)) edges.push_back({l, std::min(a, b), std::max(a, b)});
      }
    }
    return edges;
  }

  long long split_long() {
    std::vector<Edge> edges = inner_edges([](double l) { return l > kLongest; });
    std::ranges::sort(edges, [](const Edge& x, const Edge& y) {
      return std::tuple(-x.length, x.a, x.b) < std::tuple(-y.length, y.a, y.b);
    });
    long long splits = 0;
    for (const Edge& e : edges) {
      check_cancelled();
      if (mesh_.vertex_slots() >= options_.max_points) break;
      const TriCorner at = mesh_.find_inner_edge(e.a, e.b);
      if (at.t < 0) continue;
      const Vec2 middle = 0.5 * (mesh_.point(e.a) + mesh_.point(e.b));
      const int u = mesh_.across(at.t, at.k);
      const Vec2 apex[] = {mesh_.point(mesh_.vertex(at.t, at.k)),
                           mesh_.point(mesh_.vertex(u, mesh_.facing(u, at.t)))};
      const Vec2 b = mesh_.point(mesh_.vertex(at.t, at.k + 1)), c = mesh_.point(mesh_.vertex(at.t, at.k + 2));
      const bool upright = orient2d(apex[0], b, middle) > 0 && orient2d(apex[0], middle, c) > 0 &&
                           orient2d(apex[1], c, middle) > 0 && orient2d(apex[1], middle, b) > 0;
      if (!upright) continue;
      sample(mesh_.split(at.t, at.k, middle), fields_[e.a]);
      ++splits;
    }
    return splits;
  }

  long long collapse_short() {
    std::vector<Edge> edges = inner_edges([](double l) { return l < kShortest; });
    std::ranges::sort(edges, [](const Edge& x, const Edge& y) {
      return std::tuple(x.length, x.a, x.b) < std::tuple(y.length, y.a, y.b);
    });
    long long collapses = 0;
    for (const Edge& e : edges) {
      check_cancelled();
      if (mesh_.find_inner_edge(e.a, e.b).t < 0 || length(e.a, e.b) >= kShortest) continue;
      // The younger vertex is removed if possible.
      collapses += collapse(e.b, e.a) || collapse(e.a, e.b);
    }
    return collapses;
  }

  bool collapse(int from, int to) {
    if (mesh_.on_boundary(from)) return false;
    mesh_.star(from, star_);
    if (star_.size() < 4) return false;  // three triangles would become one that overlaps what is outside
    int common = 0;
    for (const auto& [t, k] : star_) {
      const int a = mesh_.vertex(t, k + 1), b = mesh_.vertex(t, k + 2);
      if (a != to && length(a, to) > kLongest) return false;
      common += mesh_.adjacent(a, to);
      if (a == to || b == to) continue;
      if (orient2d(mesh_.point(to), mesh_.point(a), mesh_.point(b)) <= 0) return false;
    }
    if (common != 2) return false;  // else an edge would exist twice
    mesh_.collapse(from, to, star_);
    return true;
  }

  long long swap_edges() {
    constexpr int kPasses = 10;
    constexpr double kBetter = 1e-6;  // far above rounding, so that no edge swaps back and forth
    long long swaps = 0;
    for (int pass = 0, changed = 1; pass < kPasses && changed > 0; ++pass) {
      changed = 0;
      for (int t = 0; t < mesh_.triangle_slots(); ++t) {
        check_cancelled();
        for (int k = 0; k < 3 && mesh_.alive(t); ++k) {
          const int u = mesh_.across(t, k);
          if (u < t) continue;
          const int a = mesh_.vertex(t, k), b = mesh_.vertex(t, k + 1), c = mesh_.vertex(t, k + 2);
          const int d = mesh_.vertex(u, mesh_.facing(u, t));
          const Frame frame = frame_of(std::array{a, b, c, d});
          const double now = std::min(measure(frame, a, b, c), measure(frame, d, c, b));
          if (std::min(measure(frame, a, b, d), measure(frame, a, d, c)) <= now + kBetter) continue;
          mesh_.swap(t, k);
          ++changed;
        }
      }
      swaps += changed;
    }
    return swaps;
  }

  long long move_vertices() {
    constexpr int kPasses = 3;
    long long moves = 0;
    for (int pass = 0; pass < kPasses; ++pass)
      for (int i = 0; i < mesh_.vertex_slots(); ++i) {
        check_cancelled();
        if (!mesh_.on_boundary(i) && mesh_.vertex_alive(i)) moves += move(i);
      }
    return moves;
  }

  /// Returns the sum of squared distances of the edges of i, placed at `at`, from their nearest ideal edges,
  /// over delta'. `step`, if given, gets the mean vector to these.
  double misfit(int i, Vec2 at, Vec2* step) const {
    double sum = 0;
    Vec2 ways;
    for (const auto& [t, k] : star_) {
      const int j = mesh_.vertex(t, k + 1);
      const Frame frame = frame_of(std::array{i, j});
      const Vec2 f = frame.of(at - mesh_.point(j)), way = nearest_ideal(f) - f;
      sum += dot(way, way);
      ways += frame.to_plane(way);
    }
    if (step != nullptr) *step = (1.0 / static_cast<double>(star_.size())) * ways;
    return sum;
  }

  /// Returns the nearest leg or hypotenuse of unit half squares along the axes.
  static Vec2 nearest_ideal(Vec2 f) {
    const auto whole = [](double x) { return std::clamp(std::round(x), -1.0, 1.0); };
    const Vec2 ideal = {whole(f.x), whole(f.y)};
    if (ideal != Vec2{}) return ideal;
    return std::abs(f.x) > std::abs(f.y) ? Vec2{std::copysign(1, f.x), 0} : Vec2{0, std::copysign(1, f.y)};
  }

  bool move(int i) {
    mesh_.star(i, star_);
    const Vec2 from = mesh_.point(i);
    Vec2 step;
    const double before = misfit(i, from, &step);
    const auto upright = [&](Vec2 at) {
      return std::ranges::all_of(star_, [&](const TriCorner& c) {
        return orient2d(at, mesh_.point(mesh_.vertex(c.t, c.k + 1)),
                        mesh_.point(mesh_.vertex(c.t, c.k + 2))) > 0;
      });
    };
    for (double part = 1; part > 0.1; part /= 2) {
      const Vec2 at = from + part * step;
      if (!upright(at) || !(misfit(i, at, nullptr) < before)) continue;
      mesh_.move(i, at);
      sample(i, fields_[i]);
      return true;
    }
    return false;
  }

  static constexpr int kFew = 1000;  // a sweep with fewer edits than 1 in so many triangles is the last one
  TriTopology mesh_;
  const CrossField& cross_;
  const ParametricSize& size_;
  AdaptationOptions options_;
  std::vector<VertexFields> fields_;
  std::vector<TriCorner> star_;
};

}  // namespace

TriPatch adapt_linf(const TriPatch& tri, const CrossField& cross, const ParametricSize& size,
                    const AdaptationOptions& options, AdaptationSummary* summary) {
  const Stopwatch watch;
  AdaptationSummary s;
  TriPatch adapted = Adaptation(tri, cross, size, options).run(s);
  s.seconds = watch.seconds();
  if (summary != nullptr) *summary = s;
  return adapted;
}

}  // namespace delquad
