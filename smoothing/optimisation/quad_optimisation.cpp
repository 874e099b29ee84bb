#include "smoothing/optimisation/quad_optimisation.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "smoothing/optimisation/track_optimisation.h"
#include "smoothing/quad_relocation.h"
#include "smoothing/short_edges.h"
#include "smoothing/untangling.h"

namespace delquad {

namespace {

/// A quad with a corner of this sine or less is untangled.
constexpr double kFlatSine = 1e-3;
/// Rings of elements around flat ones that are untangled with them.
constexpr int kUntanglingRings = 2;

/// The vertices of some elements and of `rings` rings of elements around.
std::vector<char> near(const QuadTopology& topology, const std::vector<char>& elements, int rings) {
  std::vector<char> vertex(topology.vertex_slots(), 0), inside = elements;
  for (int ring = 0;; ++ring) {
    for (int e = 0; e < topology.element_slots(); ++e)
      for (int k = 0; inside[e] && k < 4; ++k)
        if (const int v = topology.corner(e, k); v >= 0) vertex[v] = 1;
    if (ring == rings) return vertex;
    for (int e = 0; e < topology.element_slots(); ++e)
      for (int k = 0; k < 4; ++k)
        if (const int v = topology.corner(e, k); v >= 0 && vertex[v]) inside[e] = 1;
  }
}

std::vector<char> flat_quads(const QuadTopology& topology) {
  std::vector<char> flat(topology.element_slots(), 0);
  for (int e = 0; e < topology.element_slots(); ++e)
    flat[e] = topology.is_quad(e) && least_sine(topology, e) <= kFlatSine;
  return flat;
}

/// The interior vertices of one patch, free in its plane.
class PatchTracks final : public VertexTracks<Vec2> {
 public:
  PatchTracks(const QuadPatch& mesh, const ParametricSize& size, const CrossField& cross)
      : quads_(mesh.quads), size_(size), cross_(cross), points_(mesh.points), free_(mesh.points.size(), 1) {
    std::fill_n(free_.begin(), mesh.n_boundary, 0);
    for (const auto& triangle : mesh.triangles)
      for (const int v : triangle) free_[v] = 0;
  }
  Vec2 position(int v) const override { return points_[v]; }
  Vec2 put(int v, Vec2 position) override { return points_[v] = position; }
  std::array<Vec2, 2> axes(int v) const override {
    if (!free_[v]) return {};
    return {Vec2{1, 0}, Vec2{0, 1}};
  }
  double delta(const Vec2& place) const override { return size_.at(place, size_hint_); }
  Vec2 arm(int quad, int side) const override {
    const Vec2 a = points_[quads_[quad][side]], b = points_[quads_[quad][(side + 1) % 4]];
    const Cross c = cross_.at(0.5 * (a + b), cross_hint_);
    const double angle = c.angle();
    return c.c == 0 && c.s == 0 ? Vec2{} : Vec2{std::cos(angle), std::sin(angle)};
  }

 private:
  const std::vector<std::array<int, 4>>& quads_;
  const ParametricSize& size_;
  const CrossField& cross_;
  std::vector<Vec2> points_;
  std::vector<char> free_;
  mutable int size_hint_ = -1, cross_hint_ = -1;
};

}  // namespace

int untangle_flat(QuadPatch& mesh, const ParametricSize& size) {
  QuadTopology topology(mesh);
  if (lengthen_short_edges(topology, size) > 0) mesh = topology.to_patch();
  const auto flat = flat_quads(topology);
  const auto n = std::count(flat.begin(), flat.end(), 1);
  if (n == 0) return 0;
  const auto around = near(topology, flat, kUntanglingRings);
  std::vector<int> vertices;
  for (int v = mesh.n_boundary; v < topology.vertex_slots(); ++v)
    if (around[v]) vertices.push_back(v);
  untangle(topology, vertices);
  const auto left = flat_quads(topology);
  const auto n_left = std::count(left.begin(), left.end(), 1);
  if (n_left >= n) return 0;
  for (const int v : vertices) mesh.points[v] = topology.point(v);
  return static_cast<int>(n - n_left);
}

QuadPatch optimise_vertices(QuadPatch mesh, const ParametricSize& size, const CrossField& cross,
                            const OptimisationOptions& options, OptimisationSummary* summary) {
  const auto start = std::chrono::steady_clock::now();
  const int untangled = untangle_flat(mesh, size);
  PatchTracks tracks(mesh, size, cross);
  OptimisationSummary done = optimise_on_tracks(mesh.points, mesh.quads, tracks, options);
  done.untangled = untangled;
  done.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (summary != nullptr) *summary = done;
  return mesh;
}

}  // namespace delquad
