#include "features/curved/flat_corners.h"

#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "features/curved/curve_corners.h"
#include "features/curved/untangle_curved.h"

namespace delquad {

namespace {

/// The inner quad begins so far inside, as a part of the way between opposite sides.
constexpr double kRingWidth = 0.3;

void put_ring_in(Mesh& mesh, std::size_t quad, const ModelGeometry& geometry) {
  const std::array<int, 4> outer = mesh.quads[quad];
  const int region = mesh.quad_region[quad];
  const int first = static_cast<int>(mesh.points.size());
  for (int k = 0; k < 4; ++k) {
    const auto at = [&](int i) { return mesh.points[outer[(k + i) % 4]]; };
    constexpr double t = kRingWidth;
    mesh.points.push_back(
        geometry.on_face(region, (1 - t) * (1 - t) * at(0) + t * (1 - t) * (at(1) + at(3)) + t * t * at(2)));
  }
  for (int k = 0; k < 4; ++k) {
    const int next = (k + 1) % 4;
    mesh.quads.push_back({outer[k], outer[next], first + next, first + k});
    mesh.quad_region.push_back(region);
    mesh.quads[quad][k] = first + k;
  }
}

}  // namespace

int part_flat_corners(Mesh& straight, const ModelGeometry& geometry) {
  std::set<int> flat;
  for (const CurveCorner& corner : curve_corners(straight, geometry))
    if (corner.angle > std::numbers::pi / 2 && std::sin(corner.angle) < kPoorJacobian)
      flat.insert(corner.quad);
  for (const int quad : flat) put_ring_in(straight, static_cast<std::size_t>(quad), geometry);
  return static_cast<int>(flat.size());
}

}  // namespace delquad
