#include "experiments/suite/triangle_tools.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "experiments/suite/random.h"
#include "geometry/mesh/drop_unused_points.h"

namespace delquad {

void add_quad(Mesh& mesh, int a, int b, int c, int d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

void shake(Mesh& mesh, double amount, std::uint64_t seed) {
  Random random(seed);
  for (Vec3& p : mesh.points) {
    p.x += random.between(-amount, amount);
    p.y += random.between(-amount, amount);
    p.z += random.between(-amount, amount);
  }
}

void cut_holes(Mesh& mesh, const std::vector<Ball>& balls) {
  std::erase_if(mesh.triangles, [&](const std::array<int, 3>& triangle) {
    return std::ranges::any_of(triangle, [&](int v) {
      return std::ranges::any_of(
          balls, [&](const Ball& ball) { return norm(mesh.points[v] - ball.centre) < ball.radius; });
    });
  });
  drop_unused_points(mesh);
}

void subdivide(Mesh& mesh) {
  std::map<std::pair<int, int>, int> middles;
  const auto middle = [&](int a, int b) {
    const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<int>(mesh.points.size()));
    if (is_new) mesh.points.push_back(0.5 * (mesh.points[a] + mesh.points[b]));
    return at->second;
  };
  std::vector<std::array<int, 3>> triangles;
  for (const auto& [a, b, c] : mesh.triangles) {
    const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    triangles.insert(triangles.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
  }
  mesh.triangles = std::move(triangles);
}

Mesh rounded(Mesh mesh) {
  constexpr double kDigits = 1e9;
  for (Vec3& p : mesh.points)
    for (double* x : {&p.x, &p.y, &p.z}) *x = std::round(*x * kDigits) / kDigits;
  return mesh;
}

Mesh closed_grid(int n1, int n2, const std::function<Vec3(double, double)>& at) {
  Mesh mesh;
  for (int i = 0; i < n1; ++i)
    for (int j = 0; j < n2; ++j) mesh.points.push_back(at(double(i) / n1, double(j) / n2));
  const auto index = [&](int i, int j) { return i % n1 * n2 + j % n2; };
  for (int i = 0; i < n1; ++i)
    for (int j = 0; j < n2; ++j)
      add_quad(mesh, index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1));
  return mesh;
}

namespace {

/// The points of a grid of cubes with their values, and the surface between them.
class Tetrahedra {
 public:
  Tetrahedra(const std::function<double(const Vec3&)>& f, const Vec3& low, const Vec3& high, double step)
      : n_{count(low.x, high.x, step), count(low.y, high.y, step), count(low.z, high.z, step)} {
    for (int i = 0; i <= n_[0]; ++i)
      for (int j = 0; j <= n_[1]; ++j)
        for (int k = 0; k <= n_[2]; ++k) {
          points_.push_back(low + step * Vec3{double(i), double(j), double(k)});
          values_.push_back(f(points_.back()));
        }
  }

  Mesh surface() {
    for (int i = 0; i < n_[0]; ++i)
      for (int j = 0; j < n_[1]; ++j)
        for (int k = 0; k < n_[2]; ++k) cut_cube({i, j, k});
    return std::move(mesh_);
  }

 private:
  static int count(double low, double high, double step) {
    return static_cast<int>(std::ceil((high - low) / step));
  }
  int index(const std::array<int, 3>& at) const {
    return (at[0] * (n_[1] + 1) + at[1]) * (n_[2] + 1) + at[2];
  }

  /// The six ways from a cube's corner to the opposite one.
  void cut_cube(const std::array<int, 3>& corner) {
    std::array<int, 3> axes = {0, 1, 2};
    do {
      std::array<int, 4> tetrahedron = {index(corner)};
      std::array<int, 3> at = corner;
      for (int step = 0; step < 3; ++step) {
        ++at[axes[step]];
        tetrahedron[step + 1] = index(at);
      }
      cut(tetrahedron);
    } while (std::ranges::next_permutation(axes).found);
  }

  void cut(const std::array<int, 4>& tetrahedron) {
    std::vector<int> in, out;
    for (const int v : tetrahedron) (values_[v] < 0 ? in : out).push_back(v);
    if (in.empty() || out.empty()) return;
    const Vec3 outward = middle_of(out) - middle_of(in);
    if (in.size() == 2) {
      const int a = crossing(in[0], out[0]), b = crossing(in[0], out[1]), c = crossing(in[1], out[1]),
                d = crossing(in[1], out[0]);
      add({a, b, c}, outward);
      add({a, c, d}, outward);
    } else {
      const bool alone = in.size() == 1;
      const int v = alone ? in[0] : out[0];
      const std::vector<int>& others = alone ? out : in;
      add({crossing(v, others[0]), crossing(v, others[1]), crossing(v, others[2])}, outward);
    }
  }

  Vec3 middle_of(const std::vector<int>& corners) const {
    Vec3 sum;
    for (const int v : corners) sum = sum + points_[v];
    return 1.0 / static_cast<double>(corners.size()) * sum;
  }

  /// A point on an edge, near to the surface; not at its ends, where triangles would have no area.
  int crossing(int a, int b) {
    constexpr double kFromEnd = 0.15;
    if (a > b) std::swap(a, b);
    const auto [at, is_new] = crossings_.try_emplace({a, b}, static_cast<int>(mesh_.points.size()));
    if (is_new) {
      const double t = std::clamp(values_[a] / (values_[a] - values_[b]), kFromEnd, 1 - kFromEnd);
      mesh_.points.push_back(points_[a] + t * (points_[b] - points_[a]));
    }
    return at->second;
  }

  void add(std::array<int, 3> t, const Vec3& outward) {
    const std::vector<Vec3>& p = mesh_.points;
    if (dot(cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]), outward) < 0) std::swap(t[1], t[2]);
    mesh_.triangles.push_back(t);
  }

  std::array<int, 3> n_;
  std::vector<Vec3> points_;
  std::vector<double> values_;
  std::map<std::pair<int, int>, int> crossings_;
  Mesh mesh_;
};

Vec3 gradient(const std::function<double(const Vec3&)>& f, const Vec3& p) {
  constexpr double kStep = 1e-5;
  const auto slope = [&](const Vec3& by) { return (f(p + by) - f(p - by)) / (2 * kStep); };
  return {slope({kStep, 0, 0}), slope({0, kStep, 0}), slope({0, 0, kStep})};
}

/// Newton's steps along the gradient.
Vec3 moved_to_zero(const std::function<double(const Vec3&)>& f, Vec3 p) {
  for (int step = 0; step < 4; ++step) {
    const Vec3 g = gradient(f, p);
    p = p - f(p) / dot(g, g) * g;
  }
  return p;
}

}  // namespace

Mesh zero_surface(const std::function<double(const Vec3&)>& f, const Vec3& low, const Vec3& high,
                  double step) {
  Mesh mesh = Tetrahedra(f, low, high, step).surface();
  for (Vec3& p : mesh.points) p = moved_to_zero(f, p);
  return mesh;
}

}  // namespace delquad
