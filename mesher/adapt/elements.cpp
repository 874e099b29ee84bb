// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/adapt/elements.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/gauss_rule.h"
#include "base/located.h"
#include "base/text.h"
#include "geometry/mesh/check_mesh.h"
#include "geometry/mesh/element_nodes.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/outline.h"

namespace delquad {
namespace {

/// Six points, exact for degree 4.
constexpr double kA = 0.445948490915965, kB = 0.091576213509771;
constexpr double kWa = 0.223381589678011 / 2, kWb = 0.109951743655322 / 2;
constexpr std::array<Quadrature, 6> kTriangle{{{kA, kA, kWa},
                                               {1 - 2 * kA, kA, kWa},
                                               {kA, 1 - 2 * kA, kWa},
                                               {kB, kB, kWb},
                                               {1 - 2 * kB, kB, kWb},
                                               {kB, 1 - 2 * kB, kWb}}};

/// Computes Lagrange polynomials over equal distances, and their slopes.
void lagrange(int order, double x, std::array<double, kMostOrder + 1>& value,
              std::array<double, kMostOrder + 1>& slope) {
  for (int i = 0; i <= order; ++i) {
    value[i] = 1;
    slope[i] = 0;
    for (int k = 0; k <= order; ++k) {
      if (k == i) continue;
      const double scale = 1.0 / (i - k), factor = scale * (order * x - k);
      slope[i] = slope[i] * factor + value[i] * scale * order;
      value[i] *= factor;
    }
  }
}

}  // namespace

ElementMaps::ElementMaps(const Mesh& mesh, bool corners_only)
    : points_(mesh.points),
      n_triangles_(static_cast<int>(mesh.triangles.size())),
      order_(corners_only ? 1 : mesh.order) {
  for (const auto& v : mesh.triangles) {
    nodes_.insert(nodes_.end(), v.begin(), v.end());
    start_.push_back(nodes_.size());
  }
  for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
    const auto& [a, b, c, d] = mesh.quads[q];
    const std::vector<int> v = order_ == 1 ? std::vector{a, b, d, c} : nodes_of_quad(mesh, q);
    nodes_.insert(nodes_.end(), v.begin(), v.end());
    start_.push_back(nodes_.size());
  }
  const auto rule = gauss_rule(order_ + 2);
  for (const auto& [t, wt] : rule)
    for (const auto& [s, ws] : rule) of_quads_.push_back({s, t, ws * wt});
}

Shape ElementMaps::shape(int element, double s, double t) const {
  Shape shape{};
  if (is_triangle(element)) {
    shape.value = {1 - s - t, s, t};
    shape.along_s = {-1, 1, 0};
    shape.along_t = {-1, 0, 1};
    return shape;
  }
  std::array<double, kMostOrder + 1> a, b, da, db;
  lagrange(order_, s, a, da);
  lagrange(order_, t, b, db);
  for (int j = 0, n = 0; j <= order_; ++j)
    for (int i = 0; i <= order_; ++i, ++n) {
      shape.value[n] = a[i] * b[j];
      shape.along_s[n] = da[i] * b[j];
      shape.along_t[n] = a[i] * db[j];
    }
  return shape;
}

Shape ElementMaps::shape_at(int element, const Vec3& x, double s, double t) const {
  if (is_triangle(element)) {
    const auto v = nodes(element);
    const auto w = nearest_weights(points_[v[0]], points_[v[1]], points_[v[2]], x);
    return shape(element, w[1], w[2]);
  }
  constexpr int kMostSteps = 20;
  constexpr double kFar = 1, kStill = 1e-15;
  double best_s = s, best_t = t;
  for (int step = 0; step < kMostSteps; ++step) {
    const Shape at = shape(element, best_s, best_t);
    Vec3 along_s, along_t;
    const auto v = nodes(element);
    for (std::size_t k = 0; k < v.size(); ++k) {
      along_s = along_s + at.along_s[k] * points_[v[k]];
      along_t = along_t + at.along_t[k] * points_[v[k]];
    }
    const Vec3 off = x - point(element, at), normal = cross(along_s, along_t);
    const double area2 = dot(normal, normal);
    if (!(area2 > 0)) return shape(element, s, t);
    const double ds = dot(cross(off, along_t), normal) / area2, dt = dot(cross(along_s, off), normal) / area2;
    best_s += ds;
    best_t += dt;
    if (!(std::abs(best_s - 0.5) < 0.5 + kFar && std::abs(best_t - 0.5) < 0.5 + kFar))
      return shape(element, s, t);
    if (std::abs(ds) + std::abs(dt) < kStill) break;
  }
  return shape(element, std::clamp(best_s, 0.0, 1.0), std::clamp(best_t, 0.0, 1.0));
}

double ElementMaps::value(int element, const Shape& shape, std::span<const double> values) const {
  double sum = 0;
  const auto v = nodes(element);
  for (std::size_t k = 0; k < v.size(); ++k) sum += shape.value[k] * values[v[k]];
  return sum;
}

Vec3 ElementMaps::point(int element, const Shape& shape) const {
  Vec3 sum;
  const auto v = nodes(element);
  for (std::size_t k = 0; k < v.size(); ++k) sum = sum + shape.value[k] * points_[v[k]];
  return sum;
}

double ElementMaps::to_plane(int element, Shape& shape) const {
  Vec2 along_s, along_t;
  const auto v = nodes(element);
  for (std::size_t k = 0; k < v.size(); ++k) {
    const Vec2 x{points_[v[k]].x, points_[v[k]].y};
    along_s += shape.along_s[k] * x;
    along_t += shape.along_t[k] * x;
  }
  const double area = cross(along_s, along_t);
  for (std::size_t k = 0; k < v.size(); ++k) {
    const double ds = shape.along_s[k], dt = shape.along_t[k];
    shape.along_s[k] = (ds * along_t.y - dt * along_s.y) / area;
    shape.along_t[k] = (dt * along_s.x - ds * along_t.x) / area;
  }
  return std::abs(area);
}

std::span<const Quadrature> ElementMaps::quadrature(int element) const {
  if (is_triangle(element)) return kTriangle;
  return of_quads_;
}

namespace {

std::vector<std::array<int, 3>> halves_of(const Mesh& mesh) {
  std::vector<std::array<int, 3>> triangles = mesh.triangles;
  for (const auto& [a, b, c, d] : mesh.quads) triangles.insert(triangles.end(), {{a, b, c}, {a, c, d}});
  return triangles;
}

}  // namespace

ElementFinder::ElementFinder(const Mesh& mesh)
    : triangles_(mesh.points, halves_of(mesh)), n_triangles_(static_cast<int>(mesh.triangles.size())) {}

ElementFinder::Found ElementFinder::at(const Vec3& x, int& hint) const {
  const auto found = triangles_.find_from(hint, x);
  hint = found.triangle;
  const auto& w = found.weights;
  if (hint < n_triangles_) return {hint, w[1], w[2]};
  const int half = hint - n_triangles_, element = n_triangles_ + half / 2;
  return half % 2 == 0 ? Found{element, w[1] + w[2], w[2]} : Found{element, w[1], w[1] + w[2]};
}

void require_elements(const Mesh& mesh, const std::string& what) {
  require_readable(mesh, what);
  if (mesh.triangles.empty() && mesh.quads.empty()) refuse("{} has neither triangles nor quads", what);
}

void require_planar(const Mesh& mesh, const std::string& what) {
  require_elements(mesh, what);
  if (holds_surface(mesh)) refuse("{} is not planar: expected one z for all points", what);
}

void require_joined(const Mesh& mesh, const std::string& what) {
  std::vector<char> is_used(mesh.points.size(), 0);
  bool is_joined = mesh.triangles.size() + mesh.quads.size() < 2;
  for_each_element(mesh, [&](int, const auto& v) {
    for (const int i : v) is_joined = std::exchange(is_used[i], 1) != 0 || is_joined;
  });
  if (!is_joined)
    refuse(
        "{}: no two elements share a point, as if the field were discontinuous: expected elements that share "
        "points "
        "[discontinuous-field]",
        what);
}

void require_values(const Mesh& mesh, std::span<const double> values, const std::string& name) {
  if (values.size() != mesh.points.size())
    refuse("the field {} has {} values: expected one for each of the {} points of its mesh", name,
           values.size(), mesh.points.size());
  const auto check = [&](const auto& nodes) {
    for (const int i : nodes)
      if (!std::isfinite(values[i]))
        refuse("the field {} is {} at {}: expected finite values", name, values[i],
               show_point(Vec2{mesh.points[i].x, mesh.points[i].y}));
  };
  for_each_element(mesh, [&](int, const auto& v) { check(v); });
  check(mesh.quad_nodes);
}

}  // namespace delquad
