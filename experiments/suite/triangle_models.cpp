#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "delquad/mesh.h"
#include "experiments/suite/model_makers.h"
#include "experiments/suite/random.h"
#include "geometry/mesh/drop_unused_points.h"

namespace delquad {

namespace {

/// Takes away the triangles with a point in one of the balls, and the points that nothing uses.
struct Ball {
  Vec3 centre;
  double radius;
};

/// Adds the two triangles of a quad, which is split at a - c.
void add_quad(Mesh& mesh, int a, int b, int c, int d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

/// Moves every point by up to `amount` (length) along each axis.
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

/// Every triangle becomes four.
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

/// Rounds the coordinates to nine digits after the point.
Mesh rounded(Mesh mesh) {
  constexpr double kDigits = 1e9;
  for (Vec3& p : mesh.points)
    for (double* x : {&p.x, &p.y, &p.z}) *x = std::round(*x * kDigits) / kDigits;
  return mesh;
}

/// A grid of n1 x n2 quads that closes both ways, split into triangles.
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

/// The surface f = 0 of a function that is negative inside, in cubes of edge `step` between two corners, each
/// cut into six tetrahedra: triangles of any shape, slivers too.
Mesh zero_surface(const std::function<double(const Vec3&)>& f, const Vec3& low, const Vec3& high,
                  double step) {
  Mesh mesh = Tetrahedra(f, low, high, step).surface();
  for (Vec3& p : mesh.points) p = moved_to_zero(f, p);
  return mesh;
}

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
          // One after the other: the order of points must not be the compiler's.
          const int d = at(i, j + 2), c = at(i + 2, j + 2), b = at(i + 2, j), a = at(i, j);
          add_quad(mesh, a, b, c, d);
        }
  return mesh;
}

Mesh torus(int n1, int n2) {
  return closed_grid(n1, n2, [](double s, double t) {
    const double r = 1 + 0.4 * std::cos(kTurn * t);
    return Vec3{r * std::cos(kTurn * s), r * std::sin(kTurn * s), 0.4 * std::sin(kTurn * t)};
  });
}

/// The smaller of two distances, rounded where they differ by less than `blend`.
double smooth_least(double a, double b, double blend) {
  const double near = std::max(blend - std::abs(a - b), 0.0) / blend;
  return std::min(a, b) - near * near * blend / 4;
}

double three_tori(const Vec3& p) {
  constexpr double kRadius = 0.8, kTube = 0.3, kApart = 1.95;
  double least = 10;
  for (const double x : {-kApart, 0.0, kApart}) {
    const Vec2 in_plane = {norm(Vec2{p.x - x, p.y}) - kRadius, p.z};
    least = smooth_least(least, norm(in_plane) - kTube, 0.25);
  }
  return least;
}

Mesh three_blended_tori() { return zero_surface(three_tori, {-3.3, -1.3, -0.5}, {3.3, 1.3, 0.5}, 0.083); }

/// Heights on a lattice of random values, twice as fine and half as high each time.
class Heights {
 public:
  explicit Heights(std::uint64_t seed) {
    Random random(seed);
    for (double& value : values_) value = random.between(-1, 1);
  }
  double at(double x, double y) const {
    double sum = 0, scale = 1;
    for (int octave = 0; octave < 3; ++octave, scale *= 2)
      sum += layer(x * scale, y * scale) / (scale * scale);
    return sum;
  }

 private:
  static constexpr int kSide = 32;
  double layer(double x, double y) const {
    const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
    const auto smooth = [](double t) { return t * t * (3 - 2 * t); };
    const double s = smooth(x - i), t = smooth(y - j);
    const auto value = [&](int a, int b) { return values_[a % kSide * kSide + b % kSide]; };
    return (1 - s) * ((1 - t) * value(i, j) + t * value(i, j + 1)) +
           s * ((1 - t) * value(i + 1, j) + t * value(i + 1, j + 1));
  }
  std::array<double, kSide * kSide> values_;
};

/// 90 x 60 quads over 3 x 2, their points off a grid, split either way.
Mesh ground(std::uint64_t seed) {
  constexpr int kAlong = 90, kAcross = 60;
  constexpr double kStep = 3.0 / kAlong, kOff = 0.28, kHeight = 0.35;
  const Heights heights(seed);
  Random random(seed + 1);
  Mesh mesh;
  for (int i = 0; i <= kAlong; ++i)
    for (int j = 0; j <= kAcross; ++j) {
      const bool inner = i > 0 && j > 0 && i < kAlong && j < kAcross;
      const double dx = random.between(-kOff, kOff), dy = random.between(-kOff, kOff);
      const double x = kStep * (i + inner * dx), y = kStep * (j + inner * dy);
      mesh.points.push_back({x, y, kHeight * heights.at(2 * x, 2 * y)});
    }
  const auto index = [](int i, int j) { return i * (kAcross + 1) + j; };
  for (int i = 0; i < kAlong; ++i)
    for (int j = 0; j < kAcross; ++j) {
      const int a = index(i, j), b = index(i + 1, j), c = index(i + 1, j + 1), d = index(i, j + 1);
      random.between(0, 1) < 0.5 ? add_quad(mesh, a, b, c, d) : add_quad(mesh, b, c, d, a);
    }
  return mesh;
}

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

/// Three handles, with the slivers of its making.
Mesh make_genus3() { return rounded(three_blended_tori()); }

Mesh make_genus3_noisy() {
  Mesh mesh = three_blended_tori();
  shake(mesh, 0.0015, 16);
  return rounded(std::move(mesh));
}

/// Balls along a random walk, with necks between them.
Mesh make_blobs() {
  Random random(17);
  std::vector<Ball> balls = {{{0, 0, 0}, 0.5}};
  while (balls.size() < 9) {
    const Ball& last = balls.back();
    const Vec3 step = {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    const double length = norm(step), radius = random.between(0.28, 0.5);
    if (length < 0.2 || length > 1) continue;
    balls.push_back({last.centre + 0.95 * (last.radius + radius) / length * step, radius});
  }
  Vec3 low = balls[0].centre, high = low;
  for (const auto& [c, r] : balls) {
    low = {std::min(low.x, c.x - r), std::min(low.y, c.y - r), std::min(low.z, c.z - r)};
    high = {std::max(high.x, c.x + r), std::max(high.y, c.y + r), std::max(high.z, c.z + r)};
  }
  const auto distance = [&](const Vec3& p) {
    double least = 10;
    for (const auto& [c, r] : balls) least = smooth_least(least, norm(p - c) - r, 0.2);
    return least;
  };
  const Vec3 margin = {0.15, 0.15, 0.15};
  return rounded(zero_surface(distance, low - margin, high + margin, 0.065));
}

Mesh make_terrain() { return rounded(ground(18)); }

Mesh make_terrain_holes() {
  Mesh mesh = ground(20);
  std::vector<Ball> balls;
  for (const auto& [x, y, r] :
       {std::array{0.6, 0.5, 0.22}, {1.2, 1.4, 0.3}, {1.9, 0.7, 0.25}, {2.5, 1.5, 0.18}})
    for (double z = -1; z <= 1; z += 0.05) balls.push_back({{x, y, z}, r});
  cut_holes(mesh, balls);
  return rounded(std::move(mesh));
}

/// Every edge may be a feature or none: a ball with steps as large as its triangles.
Mesh make_rough_ball() {
  Mesh mesh = cube_sphere(7);
  Random random(21);
  for (Vec3& p : mesh.points) p = random.between(0.86, 1.14) * p;
  return rounded(std::move(mesh));
}

/// A box whose top is split at points that its sides know nothing of: triangles without area close the gaps.
Mesh make_flat_triangles() {
  Mesh mesh;
  mesh.points = {{0, 0, 0},   {2, 0, 0},   {2, 1, 0},   {0, 1, 0},
                 {0, 0, 0.6}, {2, 0, 0.6}, {2, 1, 0.6}, {0, 1, 0.6}};
  add_quad(mesh, 3, 2, 1, 0);
  for (int a = 0; a < 4; ++a) add_quad(mesh, a, (a + 1) % 4, (a + 1) % 4 + 4, a + 4);
  const int centre = 8;
  mesh.points.push_back({0.9, 0.55, 0.6});
  for (int a = 4; a < 8; ++a) {
    const int b = a == 7 ? 4 : a + 1, middle = static_cast<int>(mesh.points.size());
    mesh.points.push_back(mesh.points[a] + 0.375 * (mesh.points[b] - mesh.points[a]));
    mesh.triangles.insert(mesh.triangles.end(), {{a, middle, centre}, {middle, b, centre}, {a, b, middle}});
  }
  return mesh;
}

/// Three grids on one edge.
Mesh make_three_sheets() {
  constexpr int kAlong = 16, kAcross = 8;
  Mesh mesh;
  for (int i = 0; i <= kAlong; ++i) mesh.points.push_back({0, 2.0 * i / kAlong, 0});
  for (int sheet = 0; sheet < 3; ++sheet) {
    const double angle = kTurn * (sheet + 0.1 * sheet * sheet) / 3;
    const auto index = [&](int i, int j) { return j == 0 ? i : (sheet * kAcross + j) * (kAlong + 1) + i; };
    for (int j = 1; j <= kAcross; ++j)
      for (int i = 0; i <= kAlong; ++i) {
        const double r = double(j) / kAcross;
        mesh.points.push_back({r * std::cos(angle), 2.0 * i / kAlong, r * std::sin(angle)});
      }
    for (int j = 0; j < kAcross; ++j)
      for (int i = 0; i < kAlong; ++i)
        add_quad(mesh, index(i, j), index(i, j + 1), index(i + 1, j + 1), index(i + 1, j));
  }
  return rounded(std::move(mesh));
}

}  // namespace

const std::vector<SuiteMaker<Mesh>>& triangle_suite_models() {
  static const std::vector<SuiteMaker<Mesh>> kAll = {
      {"sphere_noisy", make_sphere_noisy},
      {"sphere_graded", make_sphere_graded},
      {"torus_noisy", make_torus_noisy},
      {"torus_holes", make_torus_holes},
      {"knot", make_knot},
      {"washer", make_washer},
      {"star_prism", make_star_prism},
      {"genus3", make_genus3},
      {"genus3_noisy", make_genus3_noisy},
      {"blobs", make_blobs},
      {"terrain", make_terrain},
      {"terrain_holes", make_terrain_holes},
      {"rough_ball", make_rough_ball},
      {"flat_triangles", make_flat_triangles},
      {"three_sheets", make_three_sheets},
  };
  return kAll;
}

}  // namespace delquad
