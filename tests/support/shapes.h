// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#include "delquad/mesh.h"

/// Boundaries made in code: points in loop order, the outer loop first (counterclockwise), then the holes
/// (clockwise). Each side or circle is a curve of its own, and each point is its own node.
namespace delquad::shapes {

/// Appends a closed loop through `points`; edge i runs from point i to the next and lies on curve
/// `curves[i]`.
inline void add_loop(PatchBoundary& boundary, std::span<const Vec2> points, std::span<const int> curves) {
  const int first = static_cast<int>(boundary.points.size());
  const int n = static_cast<int>(points.size());
  for (int i = 0; i < n; ++i) {
    boundary.points.push_back(points[i]);
    boundary.edges.push_back({first + i, first + (i + 1) % n});
    boundary.edge_curve.push_back(curves[i]);
    boundary.point_node.push_back(first + i);
  }
}

inline int next_curve(const PatchBoundary& boundary) {
  return boundary.edge_curve.empty() ? 0 : boundary.edge_curve.back() + 1;
}

/// Appends the polygon through `corners`, side i cut into per_side[i] equal edges.
inline void add_polygon(PatchBoundary& boundary, const std::vector<Vec2>& corners,
                        const std::vector<int>& per_side) {
  std::vector<Vec2> points;
  std::vector<int> curves;
  const int curve = next_curve(boundary);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 a = corners[i], b = corners[(i + 1) % corners.size()];
    for (int k = 0; k < per_side[i]; ++k) {
      points.push_back(a + (double(k) / per_side[i]) * (b - a));
      curves.push_back(curve + static_cast<int>(i));
    }
  }
  add_loop(boundary, points, curves);
}

/// Appends a circle of n edges; a negative radius runs clockwise: a hole.
inline void add_circle(PatchBoundary& boundary, Vec2 centre, double radius, int n) {
  std::vector<Vec2> points;
  for (int i = 0; i < n; ++i) {
    const double t = 2 * std::numbers::pi * i / n;
    points.push_back(centre + Vec2{std::abs(radius) * std::cos(t), radius * std::sin(t)});
  }
  add_loop(boundary, points, std::vector<int>(points.size(), next_curve(boundary)));
}

/// Turned by `angle` radians about the origin.
inline PatchBoundary rotated(PatchBoundary boundary, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  for (Vec2& p : boundary.points) p = {c * p.x - s * p.y, s * p.x + c * p.y};
  return boundary;
}

/// Polygon of any corners (counterclockwise), each side cut into `per_side` edges.
inline PatchBoundary polygon(const std::vector<Vec2>& corners, int per_side = 1) {
  PatchBoundary boundary;
  add_polygon(boundary, corners, std::vector<int>(corners.size(), per_side));
  return boundary;
}

/// [0, width] x [0, height] with nx by ny edges, turned about the origin.
inline PatchBoundary rectangle(double width, double height, int nx, int ny, double rotation = 0) {
  PatchBoundary boundary;
  add_polygon(boundary, {{0, 0}, {width, 0}, {width, height}, {0, height}}, {nx, ny, nx, ny});
  return rotated(std::move(boundary), rotation);
}

inline PatchBoundary disk(double radius, int n) {
  PatchBoundary boundary;
  add_circle(boundary, {0, 0}, radius, n);
  return boundary;
}

inline PatchBoundary annulus(double inner, double outer, int n_inner, int n_outer) {
  PatchBoundary boundary = disk(outer, n_outer);
  add_circle(boundary, {0, 0}, -inner, n_inner);
  return boundary;
}

/// [0, 2]^2 without (1, 2]^2, n edges a unit of length.
inline PatchBoundary l_shape(int n) {
  PatchBoundary boundary;
  add_polygon(boundary, {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, {2 * n, n, n, n, n, 2 * n});
  return boundary;
}

/// [0, side]^2, n_side edges a side, with holes x holes circular holes on a regular grid, n_hole edges each.
inline PatchBoundary plate_with_holes(double side, int n_side, int holes, double radius, int n_hole) {
  PatchBoundary boundary = rectangle(side, side, n_side, n_side);
  for (int j = 0; j < holes; ++j)
    for (int i = 0; i < holes; ++i)
      add_circle(boundary, {(i + 0.5) * side / holes, (j + 0.5) * side / holes}, -radius, n_hole);
  return boundary;
}

/// Uniform in [0, 1), the same on every platform.
inline double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

inline double segment_distance(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 d = b - a;
  const double t = std::clamp(dot(p - a, d) / dot(d, d), 0.0, 1.0);
  return norm(p - a - t * d);
}

/// Corners at random angles and radii (between half the radius and all of it) about the center;
/// counterclockwise.
inline std::vector<Vec2> random_star(std::mt19937_64& random, Vec2 centre, double radius, int n) {
  std::vector<Vec2> corners;
  const double turn = 2 * std::numbers::pi * uniform(random);
  for (int i = 0; i < n; ++i) {
    const double t = turn + 2 * std::numbers::pi * (i + 0.8 * uniform(random)) / n;
    const double r = radius * (0.5 + 0.5 * uniform(random));
    corners.push_back(centre + r * Vec2{std::cos(t), std::sin(t)});
  }
  return corners;
}

/// A random star-shaped polygon of about unit radius, re-entrant and sharp corners included, with up to five
/// holes of random size and shape. Sides are cut to edges of about h (0: not cut); the number of edges is
/// even.
inline PatchBoundary random_polygon_with_holes(std::uint64_t seed, double h = 0) {
  std::mt19937_64 random(seed);
  PatchBoundary boundary;
  const auto add = [&](std::vector<Vec2> corners) {
    std::vector<int> per_side;
    int total = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const double length = norm(corners[(i + 1) % corners.size()] - corners[i]);
      per_side.push_back(h > 0 ? std::max(1, static_cast<int>(std::lround(length / h))) : 1);
      total += per_side.back();
    }
    per_side[0] += total % 2;
    add_polygon(boundary, corners, per_side);
  };
  add(random_star(random, {0, 0}, 1, 5 + static_cast<int>(random() % 12)));
  const int holes = static_cast<int>(random() % 6);
  for (int tries = 0, made = 0; made < holes && tries < 200; ++tries) {
    const Vec2 centre = {1.4 * uniform(random) - 0.7, 1.4 * uniform(random) - 0.7};
    double clearance = 1;
    int crossings = 0;  // of the boundary so far with the ray to the right: odd inside
    for (const auto& [i, j] : boundary.edges) {
      const Vec2 a = boundary.points[i], b = boundary.points[j];
      clearance = std::min(clearance, segment_distance(centre, a, b));
      if ((a.y > centre.y) != (b.y > centre.y))
        crossings += cross(b - a, centre - a) * (b.y > a.y ? 1 : -1) > 0 ? 1 : 0;
    }
    if (crossings % 2 == 0 || clearance < 0.04) continue;
    const double radius = clearance * (0.3 + 0.6 * uniform(random));
    std::vector<Vec2> hole = random_star(random, centre, radius, 4 + static_cast<int>(random() % 5));
    std::reverse(hole.begin(), hole.end());
    add(std::move(hole));
    ++made;
  }
  return boundary;
}

}  // namespace delquad::shapes
