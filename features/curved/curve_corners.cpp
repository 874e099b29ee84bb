#include "features/curved/curve_corners.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <unordered_map>

namespace delquad {

namespace {

/// Parts of a line from whose points its tangent at the end is found, by the parabola through all three.
constexpr double kNearEnd = 0.01;

/// Away from a line's end; its length means nothing.
Vec3 tangent_at(const Mesh& mesh, const ModelGeometry& geometry, int line, int vertex) {
  const bool is_first = mesh.lines[line][0] == vertex;
  const std::array<double, 2> parts =
      is_first ? std::array{kNearEnd, 2 * kNearEnd} : std::array{1 - 2 * kNearEnd, 1 - kNearEnd};
  std::vector<Vec3> at = geometry.on_line(line, parts);
  if (!is_first) std::swap(at[0], at[1]);
  return 4.0 * at[0] - at[1] - 3.0 * mesh.points[vertex];
}

}  // namespace

std::vector<CurveCorner> curve_corners(const Mesh& straight, const ModelGeometry& geometry) {
  const auto key = [&](int a, int b) {
    const auto [lo, hi] = std::minmax(a, b);
    return static_cast<long long>(lo) * static_cast<long long>(straight.points.size()) + hi;
  };
  std::unordered_map<long long, int> line_of;  // only looked up
  for (std::size_t l = 0; l < straight.lines.size(); ++l)
    line_of.emplace(key(straight.lines[l][0], straight.lines[l][1]), static_cast<int>(l));
  const auto line_at = [&](int a, int b) {
    const auto found = line_of.find(key(a, b));
    return found == line_of.end() ? -1 : found->second;
  };
  std::vector<CurveCorner> corners;
  for (std::size_t q = 0; q < straight.quads.size(); ++q)
    for (int k = 0; k < 4; ++k) {
      const auto& v = straight.quads[q];
      const int out = line_at(v[k], v[(k + 1) % 4]), in = line_at(v[k], v[(k + 3) % 4]);
      if (out < 0 || in < 0) continue;
      const Vec3 n =
          cross(straight.points[v[2]] - straight.points[v[0]], straight.points[v[3]] - straight.points[v[1]]);
      const Vec3 a = tangent_at(straight, geometry, out, v[k]), b = tangent_at(straight, geometry, in, v[k]);
      double angle = std::atan2(dot(cross(a, b), n) / norm(n), dot(a, b));
      if (angle < -std::numbers::pi / 2) angle += 2 * std::numbers::pi;
      corners.push_back({static_cast<int>(q), k, out, in, angle});
    }
  return corners;
}

}  // namespace delquad
