// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/insertion/frontal_mesher.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "algorithms/insertion/vertex_fields.h"
#include "base/cancel.h"
#include "base/option_table.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "geometry/mesh/constrained_delaunay.h"
#include "geometry/mesh/delaunay_kernel.h"

namespace delquad {

namespace {

constexpr unsigned char kAllTried = 7;  // one bit for each side
constexpr std::size_t kBlock = 4096;    // triangles that are checked together, for any number of threads
constexpr std::array<int, 3> kNext = {1, 2, 0}, kPrev = {2, 0, 1};

struct TriangleState {
  double h = 0;             ///< dimensionless size over the ideal one
  double delta = INFINITY;  ///< delta' at the centroid, if it was too small for the triangle
  unsigned stamp = 0;       ///< number of triangles that have used this index
  unsigned char front = 0;  ///< bit k: side k is in the frozen front of this layer
  unsigned char tried = 0;  ///< bit k: insertion over side k was refused
  bool checked = false;     ///< resolved also at its own centroid
  bool listed = false;      ///< is queued for the next layer
};

struct FrontEntry {
  double h;
  int triangle;
  unsigned stamp;
  /// Orders by size, then by index, so that the mesh is reproducible.
  bool operator<(const FrontEntry& o) const { return h != o.h ? h < o.h : triangle > o.triangle; }
};

class FrontalMesher {
 public:
  FrontalMesher(const TriPatch& initial, const PointPlacement& placement, const CrossField& cross,
                const ParametricSize& size, const FrontalOptions& options)
      : placement_(placement),
        cross_(cross),
        size_(size),
        options_(options),
        h_max_(options.h_max > 0 ? options.h_max : placement.default_h_max()),
        kernel_(initial) {
    summary_.h_max = h_max_;
    VertexFields last;
    for (const Vec2 u : kernel_.points()) vertices_.push_back(last = sample(u, last));
    states_.resize(kernel_.triangles().size());
    for (int t = 0; t < static_cast<int>(states_.size()); ++t) classify_new(t);
  }

  /// Meshes layer by layer. The run ends: points keep a part of delta' from vertices around, so sizes above 0
  /// allow finitely many. A side that refused all points is tried again only if its triangle changes.
  FrontalSummary run() {
    do {
      while (start_layer()) {
        ++summary_.layers;
        while (!queue_.empty()) {
          check_cancelled();
          const FrontEntry entry = queue_.top();
          queue_.pop();
          if (states_[entry.triangle].stamp != entry.stamp) continue;
          if (summary_.inserted >= options_.max_points) {
            summary_.termination = FrontalTermination::kMaxPoints;
            return summary_;
          }
          advance(entry.triangle);
        }
      }
    } while (recheck_resolved());
    for (const TriangleState& s : states_) summary_.unresolved += s.h > h_max_;
    return summary_;
  }

  TriPatch result(int n_boundary) const { return kernel_.to_patch(n_boundary); }

 private:
  VertexFields sample(Vec2 u, const VertexFields& near) const {
    return sample_fields(cross_, size_, u, near);
  }

  bool resolved(int t) const { return states_[t].h <= h_max_; }
  /// Returns whether t is resolved or refused all points over its front. Neighbors then treat it as resolved,
  /// and the front continues behind it.
  bool settled(int t) const { return resolved(t) || states_[t].tried; }

  std::array<Vec2, 3> corners(int t) const {
    const auto& v = kernel_.triangles()[t].v;
    const auto& p = kernel_.points();
    return {p[v[0]], p[v[1]], p[v[2]]};
  }

  Cross mean_cross(int t) const {
    const auto& v = kernel_.triangles()[t].v;
    return vertices_[v[0]].cross + vertices_[v[1]].cross + vertices_[v[2]].cross;
  }

  void list_for_next_layer(int t) {
    if (states_[t].listed) return;
    states_[t].listed = true;
    next_layer_.push_back(t);
  }

  void classify_new(int t) {
    const auto& v = kernel_.triangles()[t].v;
    TriangleState& s = states_[t];
    s.h =
        placement_.triangle_size(corners(t), mean_cross(t),
                                 (vertices_[v[0]].delta + vertices_[v[1]].delta + vertices_[v[2]].delta) / 3);
    if (!resolved(t)) list_for_next_layer(t);
  }

  void recheck_neighbors(int t) {
    for (const int n : kernel_.triangles()[t].n) {
      if (n >= 0 && !resolved(n)) list_for_next_layer(n);
    }
  }

  /// Freezes the front: sides of unresolved triangles beside settled triangles and the boundary.
  bool start_layer() {
    for (const int t : next_layer_) {
      TriangleState& s = states_[t];
      s.listed = false;
      if (resolved(t)) continue;
      s.front = 0;
      for (int k = 0; k < 3; ++k) {
        const int n = kernel_.triangles()[t].n[k];
        if ((n < 0 || settled(n)) && !(s.tried & (1 << k))) s.front |= 1 << k;
      }
      if (s.front) queue_.push({s.h, t, s.stamp});
    }
    next_layer_.clear();
    return !queue_.empty();
  }

  /// Inserts a point over a front side of the triangle, and marks sides that refuse all points.
  void advance(int t) {
    for (int k = 0; k < 3; ++k) {
      if (!(states_[t].front & (1 << k))) continue;
      const unsigned stamp = states_[t].stamp;
      const FrontEdge edge = front_edge(t, k);
      const Candidates points = placement_.candidates(edge);
      for (int c = 0; c < points.count; ++c) {
        if (!try_insert(points.points[c], t, edge.frame, edge.delta)) {
          ++summary_.rejected;
          continue;
        }
        if (states_[t].stamp != stamp) return;
        break;  // inserted elsewhere: the triangle still exists
      }
      states_[t].tried |= 1 << k;
      states_[t].front &= ~(1 << k);
    }
    if (states_[t].tried != kAllTried || !split_at_centroid(t)) recheck_neighbors(t);
  }

  /// Tries the centroid of a triangle whose sides refuse all points; its edges are much longer than delta'
  /// inside.
  bool split_at_centroid(int t) {
    const auto c = corners(t);
    const Vec2 x = (1.0 / 3) * (c[0] + c[1] + c[2]);
    int hint = vertices_[kernel_.triangles()[t].v[0]].size_hint;
    return try_insert(x, t, Frame::from_cross(mean_cross(t)), size_.at(x, hint));
  }

  FrontEdge front_edge(int t, int k) const {
    const auto& tri = kernel_.triangles()[t];
    const auto& p = kernel_.points();
    const VertexFields &a = vertices_[tri.v[kNext[k]]], &b = vertices_[tri.v[kPrev[k]]];
    FrontEdge edge{p[tri.v[kNext[k]]],
                   p[tri.v[kPrev[k]]],
                   p[tri.v[k]],
                   {},
                   std::min((a.delta + b.delta) / 2, states_[t].delta),
                   Frame::from_cross(a.cross + b.cross),
                   summary_.layers,
                   &size_,
                   a.size_hint};
    if (const int n = tri.n[k]; n >= 0) {
      const auto& beyond = kernel_.triangles()[n];
      const int j = beyond.n[0] == t ? 0 : beyond.n[1] == t ? 1 : 2;
      edge.resolved_apex = p[beyond.v[j]];
    }
    return edge;
  }

  bool acceptable(Vec2 x, const Frame& frame, double delta) const {
    const auto& p = kernel_.points();
    for (const auto& e : kernel_.shell()) {
      if (placement_.length(p[e.a] - x, frame) < options_.rejection * delta) return false;
      if (e.outer >= 0) continue;
      const Vec2 ab = p[e.b] - p[e.a];
      if (cross(ab, x - p[e.a]) < kBoundaryHeight * delta * norm(ab)) return false;
    }
    return true;
  }

  bool try_insert(Vec2 x, int t, const Frame& frame, double delta) {
    const int holder = kernel_.locate(x, t);
    if (holder < 0 || !kernel_.find_cavity(x, holder) || !acceptable(x, frame, delta)) return false;

    const VertexFields near = vertices_[kernel_.triangles()[t].v[0]];
    inherited_.clear();
    for (const auto& e : kernel_.shell()) inherited_.push_back((states_[e.inner].front >> e.inner_side) & 1);
    const auto star = kernel_.insert(x);
    vertices_.push_back(sample(x, near));
    states_.resize(kernel_.triangles().size());
    for (const int n : star) {
      const unsigned stamp = states_[n].stamp + 1;
      const bool listed = states_[n].listed;
      states_[n] = {};
      states_[n].stamp = stamp;
      states_[n].listed = listed;
    }
    for (size_t i = 0; i < star.size(); ++i) classify_new(star[i]);
    for (size_t i = 0; i < star.size(); ++i) {
      const int n = star[i];
      if (resolved(n)) {
        recheck_neighbors(n);
      } else if (inherited_[i]) {
        states_[n].front = 1;  // side 0 is opposite to the new point
        queue_.push({states_[n].h, n, states_[n].stamp});
      }
    }
    ++summary_.inserted;
    return true;
  }

  /// Checks each resolved triangle once at its centroid, since all vertices may miss a narrow minimum of the
  /// size.
  bool recheck_resolved() {
    const std::size_t n = states_.size();
    std::vector<std::vector<int>> too_large((n + kBlock - 1) / kBlock);
    parallel_for(too_large.size(), [&](std::size_t block) {
      for (std::size_t t = block * kBlock; t < std::min(n, (block + 1) * kBlock); ++t)
        if (!recheck(static_cast<int>(t))) too_large[block].push_back(static_cast<int>(t));
    });
    for (const std::vector<int>& block : too_large)
      for (const int t : block) list_for_next_layer(t);
    return !next_layer_.empty();
  }

  /// Returns false if a resolved triangle is too large at its centroid.
  bool recheck(int t) {
    TriangleState& s = states_[t];
    if (s.checked || !resolved(t)) return true;
    s.checked = true;
    const auto c = corners(t);
    int hint = vertices_[kernel_.triangles()[t].v[0]].size_hint;
    const double delta = size_.at((1.0 / 3) * (c[0] + c[1] + c[2]), hint);
    const double h = placement_.triangle_size(c, mean_cross(t), delta);
    if (h <= h_max_) return true;
    s.h = h;
    s.delta = delta;
    return false;
  }

  const PointPlacement& placement_;
  const CrossField& cross_;
  const ParametricSize& size_;
  const FrontalOptions& options_;
  const double h_max_;
  DelaunayKernel kernel_;
  std::vector<VertexFields> vertices_;
  std::vector<TriangleState> states_;
  std::priority_queue<FrontEntry> queue_;
  std::vector<int> next_layer_;
  std::vector<char> inherited_;
  FrontalSummary summary_;
};

/// Returns the options; outside of their ranges the front never ends, or no point can be inserted.
const OptionTable<FrontalOptions>& insertion_table() {
  static const auto all = OptionTable<FrontalOptions>("insertion", "options of F, D and P")
                              .add({.name = "h_max",
                                    .help = "size of the triangles' circles that count as resolved",
                                    .least = 1.1,
                                    .most = 3,
                                    .absent = "the strategy's own"},
                                   &FrontalOptions::h_max)
                              .add({.name = "rejection",
                                    .help = "least distance between points, in sizes",
                                    .above = 0,
                                    .most = 0.95},
                                   &FrontalOptions::rejection);
  return all;
}

}  // namespace

OptionGroup insertion_group() { return insertion_table().group(); }
FrontalOptions insertion_options(const Options& options) { return insertion_table().read(options); }

TriPatch mesh_frontal(const PatchBoundary& boundary, const PointPlacement& placement, const CrossField& cross,
                      const ParametricSize& size, const FrontalOptions& options, FrontalSummary* summary) {
  const Stopwatch watch;
  TriPatch patch =
      fill_frontal(constrained_delaunay(boundary, boundary.seeds), placement, cross, size, options, summary);
  if (summary) summary->seconds = watch.seconds();
  return patch;
}

TriPatch fill_frontal(const TriPatch& initial, const PointPlacement& placement, const CrossField& cross,
                      const ParametricSize& size, const FrontalOptions& options, FrontalSummary* summary) {
  const Stopwatch watch;
  FrontalMesher mesher(initial, placement, cross, size, options);
  FrontalSummary done = mesher.run();
  TriPatch patch = mesher.result(initial.n_boundary);
  done.seconds = watch.seconds();
  if (summary) *summary = done;
  return patch;
}

}  // namespace delquad
