// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/insertion/frontal_mesher.h"

#include <cmath>

#include "algorithms/insertion/linf_geometry.h"
#include "algorithms/insertion/vertex_fields.h"
#include "base/cancel.h"
#include "base/stopwatch.h"
#include "geometry/mesh/constrained_delaunay.h"
#include "geometry/mesh/delaunay_kernel.h"

namespace delquad {

namespace {

/// Largest slope of an edge that follows the nearest direction of the cross: 7 degrees.
constexpr double kFollowedSlope = 0.125;
/// A grid lies beside an edge if cross and delta' hardly change over it. The cross turns by at most 2 degrees
/// (the cosine of four times that).
constexpr double kSameCross = 0.99, kSameSize = 0.05;
/// Share of the boundary's length beside which grids may stray from it.
constexpr double kMostMisaligned = 0.5;

/// Returns the direction of the frame that is nearest to d.
Vec2 nearest_direction(const Frame& frame, Vec2 d) {
  const Vec2 local = frame.to_local(d);
  if (std::abs(local.x) >= std::abs(local.y)) return local.x >= 0 ? frame.e1 : -frame.e1;
  return local.y >= 0 ? frame.e2 : -frame.e2;
}

class Packer {
 public:
  Packer(const PatchBoundary& boundary, const CrossField& cross, const ParametricSize& size,
         const FrontalOptions& options)
      : cross_(cross),
        size_(size),
        options_(options),
        kernel_(constrained_delaunay(boundary, boundary.seeds)) {
    VertexFields last;
    for (const Vec2 u : kernel_.points()) vertices_.push_back(last = sample(u, last));
    triangle_.resize(vertices_.size(), -1);
    for (int t = 0; t < static_cast<int>(kernel_.triangles().size()); ++t) {
      for (const int v : kernel_.triangles()[t].v) triangle_[v] = t;
    }
  }

  /// Begins at vertex `first`. The vertices are the queue: insertion appends them. It ends as the frontal
  /// mesher does.
  FrontalSummary run(int first) {
    for (int v = first; v < static_cast<int>(vertices_.size()); ++v) {
      check_cancelled();
      const Frame frame = Frame::from_cross(vertices_[v].cross);
      for (const Vec2 d : {frame.e1, frame.e2, -frame.e1, -frame.e2}) {
        if (summary_.inserted >= options_.max_points) {
          summary_.termination = FrontalTermination::kMaxPoints;
          return summary_;
        }
        ++(propose(v, d) ? summary_.inserted : summary_.rejected);
      }
    }
    return summary_;
  }

  /// Inserts the center of the largest circumcircle, measured in delta'. Returns the index of its vertex.
  int insert_innermost() {
    const int number = static_cast<int>(vertices_.size());
    const auto& p = kernel_.points();
    Vec2 innermost;
    VertexFields near;
    double most = 0;
    int in = -1;
    for (int t = 0; t < static_cast<int>(kernel_.triangles().size()); ++t) {
      const auto& v = kernel_.triangles()[t].v;
      const Vec2 a = p[v[1]] - p[v[0]], b = p[v[2]] - p[v[0]];
      const Vec2 way = (0.5 / ::delquad::cross(a, b)) * (dot(b, b) * perp(a) - dot(a, a) * perp(b));
      const int holder = kernel_.locate(p[v[0]] + way, t);
      if (holder < 0) continue;
      const VertexFields there = sample(p[v[0]] + way, vertices_[v[0]]);
      if (norm(way) <= most * there.delta) continue;
      most = norm(way) / there.delta;
      innermost = p[v[0]] + way, near = there, in = holder;
    }
    if (in >= 0 && kernel_.find_cavity(innermost, in)) insert(innermost, near), ++summary_.inserted;
    return number;
  }

  TriPatch result(int n_boundary) const { return kernel_.to_patch(n_boundary); }

 private:
  VertexFields sample(Vec2 u, const VertexFields& near) const {
    return sample_fields(cross_, size_, u, near);
  }

  bool propose(int v, Vec2 d) {
    const Vec2 from = kernel_.points()[v], half_way = from + 0.5 * vertices_[v].delta * d;
    const int on_the_way = kernel_.locate(half_way, triangle_[v]);
    if (on_the_way < 0) return false;  // outside, where fields need not exist
    const VertexFields middle = sample(half_way, vertices_[v]);
    const Frame frame = Frame::from_cross(middle.cross);
    const Vec2 x = from + middle.delta * nearest_direction(frame, d);
    const int holder = kernel_.locate(x, on_the_way);
    if (holder < 0 || !kernel_.find_cavity(x, holder) || !acceptable(x, frame, middle.delta)) return false;
    insert(x, middle);
    return true;
  }

  void insert(Vec2 x, const VertexFields& near) {
    vertices_.push_back(sample(x, near));
    triangle_.push_back(-1);
    for (const int t : kernel_.insert(x)) {
      for (const int w : kernel_.triangles()[t].v) triangle_[w] = t;
    }
  }

  bool acceptable(Vec2 x, const Frame& frame, double delta) const {
    const auto& p = kernel_.points();
    for (const auto& e : kernel_.shell()) {
      if (linf_norm(frame.to_local(p[e.a] - x)) < options_.rejection * delta) return false;
      if (e.outer >= 0) continue;
      const Vec2 ab = p[e.b] - p[e.a];
      if (::delquad::cross(ab, x - p[e.a]) < kBoundaryHeight * delta * norm(ab)) return false;
    }
    return true;
  }

  const CrossField& cross_;
  const ParametricSize& size_;
  const FrontalOptions& options_;
  DelaunayKernel kernel_;
  std::vector<VertexFields> vertices_;
  std::vector<int> triangle_;  ///< a triangle at each vertex
  FrontalSummary summary_;
};

}  // namespace

bool is_misaligned(const PatchBoundary& boundary, const CrossField& cross, const ParametricSize& size) {
  double length = 0, misaligned = 0;
  VertexFields last;
  for (const auto& [i, j] : boundary.edges) {
    const Vec2 p = boundary.points[i], q = boundary.points[j];
    const VertexFields a = sample_fields(cross, size, p, last), b = last = sample_fields(cross, size, q, a);
    const CanonicalEdge edge(p, q, Frame::from_cross(a.cross + b.cross));
    length += norm(q - p);
    if (std::abs(edge.beta) > kFollowedSlope * edge.alpha &&
        a.cross.c * b.cross.c + a.cross.s * b.cross.s >= kSameCross &&
        std::abs(a.delta - b.delta) <= kSameSize * a.delta)
      misaligned += norm(q - p);
  }
  return misaligned > kMostMisaligned * length;
}

TriPatch mesh_packing(const PatchBoundary& boundary, const PointPlacement& filler, const CrossField& cross,
                      const ParametricSize& size, const FrontalOptions& options, FrontalSummary* summary) {
  const Stopwatch watch;
  const int n_boundary = static_cast<int>(boundary.points.size());
  Packer packer(boundary, cross, size, options);
  const FrontalSummary packed =
      packer.run(is_misaligned(boundary, cross, size) ? packer.insert_innermost() : 0);
  FrontalOptions left = options;
  left.max_points -= packed.inserted;
  FrontalSummary done;
  TriPatch patch = fill_frontal(packer.result(n_boundary), filler, cross, size, left, &done);
  done.packed = packed.inserted;
  done.inserted += packed.inserted;
  done.rejected += packed.rejected;
  if (packed.termination != FrontalTermination::kResolved) done.termination = packed.termination;
  done.seconds = watch.seconds();
  if (summary) *summary = done;
  return patch;
}

TriPatch mesh_delquad(const PatchBoundary& boundary, const PointPlacement& placement, const CrossField& cross,
                      const ParametricSize& size, const FrontalOptions& options, FrontalSummary* summary) {
  const auto mesh = is_misaligned(boundary, cross, size) ? mesh_packing : mesh_frontal;
  return mesh(boundary, placement, cross, size, options, summary);
}

}  // namespace delquad
