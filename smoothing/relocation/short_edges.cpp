#include "smoothing/relocation/short_edges.h"

#include <algorithm>

#include "smoothing/relocation/quad_relocation.h"

namespace delquad {

namespace {

constexpr double kShort = 1e-3;  ///< of delta'
/// Parts of the way to the middle of the neighbours that are tried.
constexpr double kWays[] = {1, 0.75, 0.5, 0.25};

double least_sine_around(const QuadTopology& mesh, int v) {
  double least = 1;
  mesh.for_each_out(v, [&](int h) { least = std::min(least, least_sine(mesh, QuadTopology::element(h))); });
  return least;
}

/// Whether v moved. The mesh keeps the best of the ways with all corners around turning left.
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
