// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/optimisation/track_optimisation.h"

#include <algorithm>
#include <atomic>

#include "base/parallel.h"
#include "geometry/mesh/quad_corners.h"
#include "smoothing/relocation/untangling.h"

namespace delquad {

namespace {

/// A quad with a corner of at most this sine is untangled.
constexpr double kFlatSine = 1e-3;
/// Rings of elements around flat ones that are untangled with them.
constexpr int kUntanglingRings = 2;

/// Returns the vertices of some elements and of `rings` rings around them.
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

bool has_flat_quads(const QuadPatch& mesh) {
  std::atomic<bool> found = false;
  parallel_ranges(mesh.quads.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) {
      const auto& v = mesh.quads[q];
      const std::array at{mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]], mesh.points[v[3]]};
      if (std::ranges::min(corner_sines(at)) <= kFlatSine) found = true;
    }
  });
  return found;
}

}  // namespace

int untangle_flat(QuadPatch& mesh, const ParametricSize& size) {
  if (!has_flat_quads(mesh) && !may_have_short_edges(mesh, size)) return 0;
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

}  // namespace delquad
