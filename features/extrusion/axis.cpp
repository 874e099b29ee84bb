#include "features/extrusion/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/predicates.h"
#include "base/segment.h"
#include "base/text.h"
#include "delquad/error.h"
#include "features/extrusion/moving_section.h"

namespace delquad {

namespace {

/// Part of the section's diagonal, and of its distance from the axis' point, below which a point lies on the
/// axis: some thousand steps of a double.
constexpr double kOnAxis = 1e-12;

/// How the corners of a quad go round the origin: 0 where it lies outside.
int winding(const std::array<Vec2, 4>& corners) {
  int turns = 0;
  for (int k = 0; k < 4; ++k) {
    const Vec2 a = corners[k], b = corners[(k + 1) % 4];
    const bool a_above = a.y > 0, b_above = b.y > 0;
    if (a_above == b_above) continue;
    const int side = orient2d(a, b, {0, 0});
    if (b_above && side > 0) ++turns;
    if (a_above && side < 0) --turns;
  }
  return turns;
}

}  // namespace

void require_beside_axis(const Section& section, const Vec3& point, const Vec3& axis) {
  const Vec3 along = (1 / norm(axis)) * axis;
  const Vec3 u = unit_across(along), v = cross(along, u);
  const std::vector<Vec3>& points = section.mesh.points;
  std::vector<Vec2> seen;  // along the axis
  double reach = diagonal(section.mesh);
  for (const Vec3& p : points) {
    seen.push_back({dot(p - point, u), dot(p - point, v)});
    reach = std::max(reach, norm(p - point));
  }
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (norm(seen[i]) <= kOnAxis * reach)
      throw InputError(
          fmt::format("the node at {} lies on the axis, where hexahedra would have no sides: leave a hole "
                      "around the axis",
                      show_point(points[i])));
  for (const auto& quad : section.mesh.quads) {
    std::array<Vec2, 4> corners;
    for (int k = 0; k < 4; ++k) corners[k] = seen[quad[k]];
    for (int k = 0; k < 4; ++k)
      if (distance_to_segment(Vec2{}, corners[k], corners[(k + 1) % 4]) <= kOnAxis * reach)
        throw InputError(fmt::format("the section crosses its axis between {} and {}",
                                     show_point(points[quad[k]]), show_point(points[quad[(k + 1) % 4]])));
    if (winding(corners) != 0)
      throw InputError(fmt::format("the axis goes through the quad at {}", show_point(points[quad[0]])));
  }
}

}  // namespace delquad
