// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "geometry/mesh/half_edges.h"
#include "geometry/surface/surface_model.h"

/// Surfaces made in code.
namespace delquad::testing_support {

/// One face whose outline is made of closed curves, one for each boundary loop; no corners.
inline SurfaceModel one_face(std::vector<Vec3> points, std::vector<std::array<int, 3>> triangles) {
  SurfaceModel model;
  Mesh& mesh = model.fine;
  mesh.points = std::move(points);
  mesh.triangles = std::move(triangles);
  mesh.triangle_region.assign(mesh.triangles.size(), 0);
  mesh.regions = {{1, {}}};
  std::map<int, int> next;
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  for_each_edge(std::span(sides), [&](std::span<const HalfEdge> edge) {
    if (edge.size() == 1)
      next[edge[0].forward ? edge[0].lo : edge[0].hi] = edge[0].forward ? edge[0].hi : edge[0].lo;
  });
  while (!next.empty()) {
    const int curve = static_cast<int>(mesh.curves.size());
    mesh.curves.push_back({curve + 1, {}});
    for (int v = next.begin()->first; next.contains(v);) {
      const int w = next[v];
      next.erase(v);
      mesh.lines.push_back({v, w});
      mesh.line_curve.push_back(curve);
      v = w;
    }
  }
  return model;
}

/// nu x nv squares of a parameter rectangle [0, 1]^2, each cut in two along alternating diagonals; the sides
/// are glued where asked.
struct GridShape {
  int nu = 8, nv = 8;
  bool wrap_u = false, wrap_v = false;
  bool pole = false;  ///< v = 0 is one point
};

inline SurfaceModel grid_surface(const GridShape& g, const std::function<Vec3(double, double)>& at) {
  std::vector<Vec3> points;
  std::map<std::pair<int, int>, int> index;
  auto node = [&](int i, int j) {
    if (g.wrap_u) i %= g.nu;
    if (g.wrap_v) j %= g.nv;
    if (g.pole && j == 0) i = 0;
    const auto [found, fresh] = index.try_emplace({i, j}, static_cast<int>(points.size()));
    if (fresh) points.push_back(at(double(i) / g.nu, double(j) / g.nv));
    return found->second;
  };
  std::vector<std::array<int, 3>> triangles;
  auto add = [&](int a, int b, int c) {
    if (a != b && b != c && c != a) triangles.push_back({a, b, c});
  };
  for (int j = 0; j < g.nv; ++j) {
    for (int i = 0; i < g.nu; ++i) {
      const int a = node(i, j), b = node(i + 1, j), c = node(i + 1, j + 1), d = node(i, j + 1);
      if ((i + j) % 2 == 0) {
        add(a, b, c);
        add(a, c, d);
      } else {
        add(a, b, d);
        add(b, c, d);
      }
    }
  }
  return one_face(std::move(points), std::move(triangles));
}

inline SurfaceModel bump(int n, double height) {
  return grid_surface({n, n}, [=](double u, double v) {
    const double x = 2 * u - 1, y = 2 * v - 1;
    return Vec3{x, y, height * std::exp(-4 * (x * x + y * y)) + 0.2 * height * std::sin(5 * x + 2 * y)};
  });
}

/// Open at both ends, normals outwards.
inline SurfaceModel cylinder(int n_around, int n_along, double radius, double height) {
  return grid_surface({n_around, n_along, true}, [=](double u, double v) {
    const double phi = 2 * std::numbers::pi * u;
    return Vec3{radius * std::cos(phi), radius * std::sin(phi), height * v};
  });
}

/// From the apex at v = 0 to a circle; the slant side is 1 long.
inline SurfaceModel cone(int n_around, int n_along, double half_angle) {
  return grid_surface({n_around, n_along, true, false, true}, [=](double u, double v) {
    const double phi = 2 * std::numbers::pi * u, r = v * std::sin(half_angle);
    return Vec3{r * std::cos(phi), r * std::sin(phi), -v * std::cos(half_angle)};
  });
}

/// Cap of the unit sphere around its pole, up to a polar angle.
inline SurfaceModel sphere_cap(int n_around, int n_along, double polar_angle) {
  return grid_surface({n_around, n_along, true, false, true}, [=](double u, double v) {
    const double phi = 2 * std::numbers::pi * u, theta = polar_angle * v;
    return Vec3{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
  });
}

inline SurfaceModel torus(int n_around, int n_tube, double radius, double tube) {
  return grid_surface({n_around, n_tube, true, true}, [=](double u, double v) {
    const double phi = 2 * std::numbers::pi * u, psi = 2 * std::numbers::pi * v;
    const double r = radius + tube * std::cos(psi);
    return Vec3{r * std::cos(phi), r * std::sin(phi), tube * std::sin(psi)};
  });
}

/// The sides of a set of unit cubes, each of n x n squares, then rounded by averaging neighbors. Sides
/// between a cube of the set and a missing one for which `open` is true are left out.
class CubeSurface {
 public:
  using Cube = std::array<int, 3>;
  CubeSurface(std::vector<Cube> cubes, std::vector<Cube> open, int n) : n_(n) {
    auto contains = [](const std::vector<Cube>& set, const Cube& c) {
      return std::ranges::find(set, c) != set.end();
    };
    for (const Cube& c : cubes)
      for (int axis = 0; axis < 3; ++axis)
        for (int sign : {-1, 1}) {
          Cube other = c;
          other[axis] += sign;
          if (!contains(cubes, other) && !contains(open, other)) add_side(c, axis, sign > 0);
        }
  }

  SurfaceModel rounded(int rounds) {
    SurfaceModel model = one_face(points_, triangles_);
    Mesh& mesh = model.fine;
    std::vector<char> fixed(mesh.points.size(), 0);
    for (const auto& line : mesh.lines) fixed[line[0]] = 1;
    for (int r = 0; r < rounds; ++r) {
      std::vector<Vec3> sum(mesh.points.size());
      std::vector<int> count(mesh.points.size(), 0);
      for (const auto& v : mesh.triangles)
        for (int k = 0; k < 3; ++k) {
          sum[v[k]] = sum[v[k]] + mesh.points[v[(k + 1) % 3]];
          ++count[v[k]];
        }
      for (std::size_t i = 0; i < sum.size(); ++i)
        if (!fixed[i]) mesh.points[i] = (1.0 / count[i]) * sum[i];
    }
    return model;
  }

 private:
  int node(std::array<int, 3> key) {
    const auto [found, fresh] = index_.try_emplace(key, static_cast<int>(points_.size()));
    if (fresh) points_.push_back({double(key[0]) / n_, double(key[1]) / n_, double(key[2]) / n_});
    return found->second;
  }
  void add_side(const Cube& c, int axis, bool far) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int i = 0; i < n_; ++i)
      for (int j = 0; j < n_; ++j) {
        int corner[4];
        for (int q = 0; q < 4; ++q) {
          std::array<int, 3> key = {c[0] * n_, c[1] * n_, c[2] * n_};
          key[axis] += far ? n_ : 0;
          key[u] += i + (q == 1 || q == 2);
          key[v] += j + (q >= 2);
          corner[q] = node(key);
        }
        if (!far) std::swap(corner[1], corner[3]);
        triangles_.push_back({corner[0], corner[1], corner[2]});
        triangles_.push_back({corner[0], corner[2], corner[3]});
      }
  }

  int n_;
  std::map<std::array<int, 3>, int> index_;
  std::vector<Vec3> points_;
  std::vector<std::array<int, 3>> triangles_;
};

inline SurfaceModel round_sphere(int n) {
  SurfaceModel model = CubeSurface({{0, 0, 0}}, {}, n).rounded(0);
  for (Vec3& p : model.fine.points) {
    p = p - Vec3{0.5, 0.5, 0.5};
    p = (1 / norm(p)) * p;
  }
  return model;
}

/// Three tubes that meet, open at their ends.
inline SurfaceModel tee(int n) {
  return CubeSurface({{-3, 0, 0},
                      {-2, 0, 0},
                      {-1, 0, 0},
                      {0, 0, 0},
                      {1, 0, 0},
                      {2, 0, 0},
                      {3, 0, 0},
                      {0, 0, 1},
                      {0, 0, 2},
                      {0, 0, 3}},
                     {{-4, 0, 0}, {4, 0, 0}, {0, 0, 4}}, n)
      .rounded(2 * n);
}

/// Closed, with two handles.
inline SurfaceModel double_torus(int n) {
  std::vector<CubeSurface::Cube> cubes;
  for (int x = 0; x < 5; ++x)
    for (int y = 0; y < 3; ++y)
      if (y != 1 || x % 2 == 0) cubes.push_back({x, y, 0});
  return CubeSurface(cubes, {}, n).rounded(n);
}

}  // namespace delquad::testing_support
