// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/fields/singularities.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>

namespace delquad {

namespace {

constexpr double kPi = std::numbers::pi;

/// Returns the turn of the phase (radians) from one side to another: `expected` plus a rest from -pi to pi.
/// The turn from the second to the first is opposite.
double phase_step(const std::vector<double>& phase, int from, int to, double expected) {
  if (from > to) return -phase_step(phase, to, from, -expected);
  const double step = phase[to] - phase[from];
  const double rest = std::remainder(step - expected, 2 * kPi);
  return expected + (rest <= -kPi ? rest + 2 * kPi : rest);
}

int turns(double angle) { return static_cast<int>(std::lround(angle / (2 * kPi))); }

/// Returns the angle (radians) by which the boundary turns at each vertex; 0 inside.
std::vector<double> boundary_turns(const BackgroundMesh& background) {
  const TriPatch& tri = background.triangles();
  const auto& boundary = background.boundary_points();
  std::vector<double> turn(tri.points.size(), 0);
  for (std::size_t t = 0; t < tri.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (tri.neighbours[t][k] >= 0) continue;
      const int from = tri.triangles[t][(k + 1) % 3], to = tri.triangles[t][(k + 2) % 3];
      const Vec2 in = boundary[from].tangent, out = boundary[to].tangent;
      turn[to] = std::atan2(cross(in, out), dot(in, out));
    }
  }
  return turn;
}

/// Returns the place in a triangle where the field, linear between the middles of sides, vanishes.
Vec2 zero_point(const Vec2 (&middle)[3], const Cross (&z)[3]) {
  const Vec2 a = {z[0].c, z[0].s}, b = {z[1].c, z[1].s}, c = {z[2].c, z[2].s};
  const double weight[] = {std::abs(cross(b, c)), std::abs(cross(c, a)), std::abs(cross(a, b))};
  const double sum = weight[0] + weight[1] + weight[2];
  if (!(sum > 0)) return (1.0 / 3) * (middle[0] + middle[1] + middle[2]);
  return (1 / sum) * (weight[0] * middle[0] + weight[1] * middle[1] + weight[2] * middle[2]);
}

void cancel(int& a, int& b) {
  if (a == 0 || b == 0 || (a > 0) == (b > 0)) return;
  const int n = std::min(std::abs(a), std::abs(b)) * (a > 0 ? 1 : -1);
  a -= n;
  b += n;
}

/// Removes opposite indices of touching cells: a triangle and a vertex, two triangles, or two vertices.
void cancel_pairs(const TriPatch& tri, const std::vector<char>& is_inside, std::vector<int>& of_triangle,
                  std::vector<int>& of_vertex) {
  for (std::size_t t = 0; t < tri.triangles.size(); ++t) {
    for (const int v : tri.triangles[t]) {
      if (is_inside[v]) cancel(of_triangle[t], of_vertex[v]);
    }
  }
  for (std::size_t t = 0; t < tri.triangles.size(); ++t) {
    for (const int other : tri.neighbours[t]) {
      if (other >= 0) cancel(of_triangle[t], of_triangle[other]);
    }
    for (int k = 0; k < 3; ++k) {
      const int a = tri.triangles[t][k], b = tri.triangles[t][(k + 1) % 3];
      if (is_inside[a] && is_inside[b]) cancel(of_vertex[a], of_vertex[b]);
    }
  }
}

}  // namespace

FieldWinding find_winding(const BackgroundMesh& background, const Sides& sides,
                          const std::vector<Cross>& crosses,
                          const std::vector<std::array<double, 3>>& expected) {
  const TriPatch& tri = background.triangles();
  std::vector<double> phase;
  phase.reserve(crosses.size());
  for (const Cross& z : crosses) phase.push_back(std::atan2(z.s, z.c));

  FieldWinding winding{std::vector<int>(tri.triangles.size()), boundary_turns(background), {}};
  for (double& angle : winding.of_vertex) angle *= 4;
  for (std::size_t t = 0; t < tri.triangles.size(); ++t) {
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
      // Counterclockwise in the triangle, past the middles of the two sides at vertex k; clockwise around
      // that vertex.
      const int from = (k + 2) % 3, to = (k + 1) % 3;
      const double step = phase_step(phase, sides.of_triangle[t][from], sides.of_triangle[t][to],
                                     expected.empty() ? 0 : expected[t][to] - expected[t][from]);
      sum -= step;
      winding.of_vertex[tri.triangles[t][k]] += step;
    }
    winding.of_triangle[t] = turns(sum);
  }
  for (double& angle : winding.of_vertex) angle /= 2 * kPi;
  for (const auto& vertex : background.boundary_points()) winding.is_inside.push_back(vertex.from < 0);
  return winding;
}

void join_windings(const std::vector<JoinedVertices>& joined, std::vector<FieldWinding>& windings) {
  for (const auto& [vertices, n_shared] : joined) {
    double sum = 0;
    for (const auto& [patch, vertex] : vertices) sum += std::exchange(windings[patch].of_vertex[vertex], 0.0);
    // Each part has turned by pi less its angle; two parts at a shared side need half a turn less of each.
    const auto [patch, vertex] = vertices.front();
    const int n = static_cast<int>(vertices.size());
    windings[patch].of_vertex[vertex] = sum - 4 * (n - 1) + 2 * n_shared;
    windings[patch].is_inside[vertex] = n_shared == n;
  }
}

FieldTopology find_singularities(const BackgroundMesh& background, const Sides& sides,
                                 const std::vector<Cross>& crosses, const FieldWinding& winding) {
  const TriPatch& tri = background.triangles();
  std::vector<int> of_triangle = winding.of_triangle, of_vertex;
  of_vertex.reserve(winding.of_vertex.size());
  for (const double n : winding.of_vertex) of_vertex.push_back(static_cast<int>(std::lround(n)));

  FieldTopology result;
  result.euler_characteristic =
      static_cast<int>(tri.triangles.size()) - sides.count + static_cast<int>(tri.points.size());
  for (const int index : of_triangle) result.index_sum += index;
  for (const int index : of_vertex) result.index_sum += index;
  cancel_pairs(tri, winding.is_inside, of_triangle, of_vertex);
  for (std::size_t t = 0; t < of_triangle.size(); ++t) {
    if (of_triangle[t] == 0) continue;
    Vec2 middle[3];
    Cross z[3];
    for (int k = 0; k < 3; ++k) {
      const auto& v = tri.triangles[t];
      middle[k] = 0.5 * (tri.points[v[(k + 1) % 3]] + tri.points[v[(k + 2) % 3]]);
      z[k] = crosses[sides.of_triangle[t][k]];
    }
    result.singularities.push_back({zero_point(middle, z), of_triangle[t]});
  }
  for (std::size_t v = 0; v < of_vertex.size(); ++v) {
    if (of_vertex[v] != 0 && winding.is_inside[v]) {
      result.singularities.push_back({tri.points[v], of_vertex[v]});
    }
  }
  return result;
}

}  // namespace delquad
