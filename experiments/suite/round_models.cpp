#include <cmath>
#include <map>
#include <numbers>

#include "experiments/suite/triangle_models.h"
#include "experiments/suite/triangle_tools.h"

namespace delquad {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// The sides of a cube with n x n quads each, blown up to the unit sphere.
Mesh cube_sphere(int n) {
  Mesh mesh;
  std::map<std::array<int, 3>, int> known;
  const auto vertex = [&](const std::array<int, 3>& at) {
    const auto [place, is_new] = known.try_emplace(at, static_cast<int>(mesh.points.size()));
    const Vec3 p = Vec3{double(at[0]), double(at[1]), double(at[2])};
    if (is_new) mesh.points.push_back(1 / norm(p) * p);
    return place->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {-n, n})
      for (int i = -n; i < n; i += 2)
        for (int j = -n; j < n; j += 2) {
          const auto at = [&](int u, int v) {
            std::array<int, 3> p;
            p[axis] = side;
            p[(axis + 1) % 3] = side > 0 ? u : v;
            p[(axis + 2) % 3] = side > 0 ? v : u;
            return vertex(p);
          };
          add_quad(mesh, at(i, j), at(i + 2, j), at(i + 2, j + 2), at(i, j + 2));
        }
  return mesh;
}

Mesh torus(int n1, int n2) {
  return closed_grid(n1, n2, [](double s, double t) {
    const double r = 1 + 0.4 * std::cos(kTurn * t);
    return Vec3{r * std::cos(kTurn * s), r * std::sin(kTurn * s), 0.4 * std::sin(kTurn * t)};
  });
}

}  // namespace

Mesh make_sphere_noisy() {
  Mesh mesh = cube_sphere(24);
  shake(mesh, 0.004, 11);
  return rounded(std::move(mesh));
}

/// Sampled nine times as densely at one pole as at the other.
Mesh make_sphere_graded() {
  Mesh mesh = cube_sphere(30);
  for (Vec3& p : mesh.points) {
    const Vec3 moved = p + Vec3{0, 0, 0.5};
    p = 1 / norm(moved) * moved;
  }
  shake(mesh, 0.001, 12);
  return rounded(std::move(mesh));
}

Mesh make_torus_noisy() {
  Mesh mesh = torus(96, 40);
  shake(mesh, 0.004, 13);
  return rounded(std::move(mesh));
}

Mesh make_torus_holes() {
  Mesh mesh = torus(128, 56);
  cut_holes(mesh, {{{1.4, 0, 0}, 0.22}, {{0, 1, 0.4}, 0.18}, {{-1, 0, 0.4}, 0.3}, {{0, -0.6, 0}, 0.16}});
  shake(mesh, 0.002, 14);
  return rounded(std::move(mesh));
}

/// A tube along a trefoil, with longer triangles at one side.
Mesh make_knot() {
  return rounded(closed_grid(360, 20, [](double s, double t) {
    const double u = kTurn * s + 0.5 * std::sin(kTurn * s);
    const double cu = std::cos(2 * u), su = std::sin(2 * u), r = 2 + std::cos(3 * u);
    const Vec3 normal = {std::cos(3 * u) * cu, std::cos(3 * u) * su, std::sin(3 * u)};
    const double dr = -3 * std::sin(3 * u);
    const Vec3 tangent = {dr * cu - 2 * r * su, dr * su + 2 * r * cu, 3 * std::cos(3 * u)};
    const Vec3 side = 1 / norm(tangent) * cross(normal, tangent);
    const double angle = kTurn * t;
    return Vec3{r * cu, r * su, std::sin(3 * u)} + 0.3 * (std::cos(angle) * normal + std::sin(angle) * side);
  }));
}

/// As programs write STL: triangles as long as the part is high, and longer ones on its flat sides.
Mesh make_washer() {
  constexpr int kSides = 120;
  constexpr double kInner = 0.35, kHeight = 0.6;
  Mesh mesh;
  for (int k = 0; k < kSides; ++k)
    for (const auto& [r, z] : {std::pair(1.0, 0.0), {1.0, kHeight}, {kInner, kHeight}, {kInner, 0.0}})
      mesh.points.push_back({r * std::cos(kTurn * k / kSides), r * std::sin(kTurn * k / kSides), z});
  for (int k = 0; k < kSides; ++k)
    for (int side = 0; side < 4; ++side) {
      const int next = (k + 1) % kSides, other = (side + 1) % 4;
      add_quad(mesh, 4 * k + side, 4 * next + side, 4 * next + other, 4 * k + other);
    }
  return rounded(std::move(mesh));
}

/// A star of seven rays pulled up, with noise on its sides and edges.
Mesh make_star_prism() {
  constexpr int kRays = 7, kCorners = 2 * kRays, kLevels = 4;
  constexpr double kHeight = 0.5;
  Mesh mesh;
  for (int k = 0; k < kCorners; ++k)
    for (const double z : {0.0, kHeight}) {
      const double r = k % 2 == 0 ? 1 : 0.62, angle = kTurn * k / kCorners;
      mesh.points.push_back({r * std::cos(angle), r * std::sin(angle), z});
    }
  const int below = 2 * kCorners, above = below + 1;
  mesh.points.push_back({0, 0, 0});
  mesh.points.push_back({0, 0, kHeight});
  for (int k = 0; k < kCorners; ++k) {
    const int a = 2 * k, b = 2 * ((k + 1) % kCorners);
    add_quad(mesh, a, b, b + 1, a + 1);
    mesh.triangles.push_back({b, a, below});
    mesh.triangles.push_back({a + 1, b + 1, above});
  }
  for (int level = 0; level < kLevels; ++level) subdivide(mesh);
  shake(mesh, 0.001, 15);
  return rounded(std::move(mesh));
}

}  // namespace delquad
