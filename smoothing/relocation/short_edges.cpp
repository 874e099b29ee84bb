// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/relocation/untangling.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <vector>

#include "base/parallel.h"
#include "smoothing/relocation/quad_relocation.h"

namespace delquad {

namespace {

constexpr double kShort = 1e-3;  ///< in delta'
/// Tried parts of the way to the middle of the neighbors.
constexpr double kWays[] = {1, 0.75, 0.5, 0.25};

double least_sine_around(const QuadTopology& mesh, int v) {
  double least = 1;
  mesh.for_each_out(v, [&](int h) { least = std::min(least, least_sine(mesh, QuadTopology::element(h))); });
  return least;
}

/// Moves v to the best of these places with all corners around turning left. Returns whether it moved.
bool move_to_middle(QuadTopology& mesh, int v) {
  const Vec2 start = mesh.point(v);
  Vec2 middle, best = start;
  int n = 0;
  mesh.for_each_out(v, [&](int h) { middle += mesh.point(mesh.target(h)), ++n; });
  middle = (1.0 / n) * middle;
  double sine = 0;
  for (const double way : kWays) {
    mesh.move(v, start + way * (middle - start));
    if (const double least = least_sine_around(mesh, v); least > sine) sine = least, best = mesh.point(v);
  }
  mesh.move(v, best);
  return sine > 0;
}

}  // namespace

bool may_have_short_edges(const QuadPatch& mesh, const ParametricSize& size) {
  std::vector<double> shortest(mesh.points.size(), std::numeric_limits<double>::infinity());
  const auto add = [&](const auto& corners) {
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const int a = corners[k], b = corners[(k + 1) % corners.size()];
      const double length = norm(mesh.points[b] - mesh.points[a]);
      shortest[a] = std::min(shortest[a], length), shortest[b] = std::min(shortest[b], length);
    }
  };
  for (const auto& quad : mesh.quads) add(quad);
  for (const auto& triangle : mesh.triangles) add(triangle);
  std::atomic<bool> found = false;
  parallel_ranges(shortest.size(), [&](std::size_t begin, std::size_t end) {
    int hint = -1;
    for (std::size_t v = begin; v < end; ++v)
      if (shortest[v] < kShort * size.at(mesh.points[v], hint)) found = true;
  });
  return found;
}

int lengthen_short_edges(QuadTopology& mesh, const ParametricSize& size) {
  int moved = 0, hint = -1;
  for (int h = 0; h < 4 * mesh.element_slots(); ++h) {
    if (mesh.origin(h) < 0) continue;
    const int a = mesh.origin(h), b = mesh.target(h);
    if (norm(mesh.point(b) - mesh.point(a)) >= kShort * size.at(mesh.point(a), hint)) continue;
    for (const int v : {std::max(a, b), std::min(a, b)})
      if (!mesh.on_boundary(v) && move_to_middle(mesh, v)) {
        ++moved;
        break;
      }
  }
  return moved;
}

}  // namespace delquad
