// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "features/volume/hexahedra_steps.h"

namespace delquad {
namespace {

/// Direction of rays, along no plane that models have.
constexpr Vec3 kRay = {1, 0.0271828182846, 0.0314159265359};

bool is_hit(const Vec3& x, const std::array<Vec3, 3>& triangle) {
  const Vec3 a = triangle[0] - x, b = triangle[1] - x, c = triangle[2] - x;
  const double u = dot(kRay, cross(b, c)), v = dot(kRay, cross(c, a)), w = dot(kRay, cross(a, b));
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return false;
  const double sum = u + v + w;
  return sum != 0 && dot(a, cross(b, c)) / sum > 0;
}

using std::numbers::sqrt2;
using Vec6 = Eigen::Vector<double, 6>;

/// Products of two coordinates. Their dot products are the squares of dot products.
Vec6 squares(const Vec3& a) {
  return {a.x * a.x, a.y * a.y, a.z * a.z, sqrt2 * a.x * a.y, sqrt2 * a.x * a.z, sqrt2 * a.y * a.z};
}

/// Returns a quarter of the gradient of the polynomial.
Vec3 gradient(const FrameValues& values, const Vec3& x) {
  const Vec6 m = values.leftCols<6>() * squares(x);
  return {m[0] * x.x + (m[3] * x.y + m[4] * x.z) / sqrt2, m[1] * x.y + (m[3] * x.x + m[5] * x.z) / sqrt2,
          m[2] * x.z + (m[4] * x.x + m[5] * x.y) / sqrt2};
}

double along(const FrameValues& values, const Vec3& a) { return values.col(6).dot(squares(a)); }

/// Returns the rotation nearest to the matrix of three rows, by Newton's iteration; the guess if it fails.
Axes nearest_rotation(Axes x, const Axes& guess) {
  for (int i = 0; i < 20; ++i) {
    Axes c = {cross(x[1], x[2]), cross(x[2], x[0]), cross(x[0], x[1])};
    const double det = dot(x[0], c[0]);
    if (!(det > 1e-12)) return guess;
    double change = 0;
    for (int k = 0; k < 3; ++k) {
      const Vec3 next = 0.5 * (x[k] + (1 / det) * c[k]);
      change = std::max(change, norm(next - x[k]));
      x[k] = next;
    }
    if (change < 1e-8) break;
  }
  return x;
}

/// Maximizes the sum of the polynomial over the axes: the polar part of the gradients does not lower it, as
/// the polynomial is convex.
Axes project(const FrameValues& values, Axes axes) {
  for (int i = 0; i < 30; ++i) {
    Axes gradients;
    for (int k = 0; k < 3; ++k) gradients[k] = gradient(values, axes[k]) + 0.02 * axes[k];
    const Axes next = nearest_rotation(gradients, axes);
    const double change =
        std::max({norm(next[0] - axes[0]), norm(next[1] - axes[1]), norm(next[2] - axes[2])});
    axes = next;
    if (change < 2e-3) break;
  }
  return axes;
}

/// Sine of the diagonals of a quad below which it tells no directions.
constexpr double kFlat = 1e-6;
/// Least size, in the median at the skin.
constexpr double kLeastSize = 0.02;

}  // namespace

Skin::Skin(const Mesh& body) : body_(body), nearest_(body.points, halves_of(body.quads)) {
  std::vector<Box<Vec3>> boxes;
  for (const Triangle& t : halves_of(body.quads)) {
    corners_.push_back({body.points[t[0]], body.points[t[1]], body.points[t[2]]});
    boxes.push_back(Box<Vec3>::around(std::span<const Vec3>(corners_.back())));
  }
  tree_ = BoxTree<Vec3>(boxes);
}

bool Skin::contains(const Vec3& x) const {
  const auto bound = [&](const BoxTree<Vec3>::Node& node) {
    double from = 0, to = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
      const double speed = coordinate(kRay, k), at = coordinate(x, k);
      from = std::max(from, (coordinate(node.box.low, k) - at) / speed);
      to = std::min(to, (coordinate(node.box.high, k) - at) / speed);
    }
    return from <= to ? 0.0 : 1.0;
  };
  bool inside = false;
  tree_.search(0.0, bound, [&](int t) { inside ^= is_hit(x, corners_[t]); });
  return inside;
}

void set_axes(FrameValues& values, const Axes& axes) {
  values.leftCols<6>().setZero();
  for (const Vec3& a : axes) values.leftCols<6>() += squares(a) * squares(a).transpose();
}

SkinFrames::SkinFrames(const Mesh& skin) {
  const auto& points = skin.points;
  const std::size_t n = points.size();
  known.assign(n, {});
  values.assign(n, FrameValues::Zero());
  std::vector<Axes> axes(n, {Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  for (const Quad& q : skin.quads) {
    const Vec3 d = direction_of(points[q[2]] - points[q[0]]), e = direction_of(points[q[3]] - points[q[1]]);
    if (norm(cross(d, e)) < kFlat) continue;
    const Vec3 u = direction_of(d - e), normal = direction_of(cross(d, e));
    const Axes of_quad = {u, cross(normal, u), normal};
    FrameValues value = FrameValues::Zero();
    set_axes(value, of_quad);
    for (const int v : q) values[v] += value, axes[v] = of_quad;
  }
  std::vector<std::array<double, 3>> counts(n);
  for (std::size_t v = 0; v < n; ++v) set_axes(values[v], axes[v] = project(values[v], axes[v]));
  for_each_side(skin, [&](int v, int w) {
    const Vec3 e = points[w] - points[v];
    std::array<double, 3> parts;
    for (int i = 0; i < 3; ++i) parts[i] = std::abs(dot(e, axes[v][i]));
    const auto axis = std::ranges::max_element(parts) - parts.begin();
    if (parts[axis] >= 0.75 * norm(e)) known[v][axis] += norm(e), counts[v][axis] += 1;
  });
  std::vector<double> means;
  for (std::size_t v = 0; v < n; ++v) {
    double sum = 0, count = 0;
    for (int k = 0; k < 3; ++k) {
      sum += known[v][k], count += counts[v][k];
      known[v][k] /= std::max(counts[v][k], 1.0);
    }
    means.push_back(sum / std::max(count, 1.0));
    for (int k = 0; k < 3; ++k)
      values[v].col(6) += (known[v][k] > 0 ? known[v][k] : means[v]) * squares(axes[v][k]);
  }
  std::ranges::nth_element(means, means.begin() + n / 2);
  usual_size = means[n / 2];
  for (std::size_t v = 0; v < n; ++v) frames.push_back(frame_of(values[v], axes[v]));
}

void SkinFrames::keep_known_sizes(FrameValues& at, int v) const {
  for (int k = 0; k < 3; ++k)
    if (const Vec3& a = frames[v].axes[k]; known[v][k] > 0)
      at.col(6) += (known[v][k] - along(at, a)) * squares(a);
}

Frame SkinFrames::frame_of(const FrameValues& at, const Axes& guess) const {
  Frame frame{project(at, guess), {}};
  for (int k = 0; k < 3; ++k) frame.sizes[k] = std::max(kLeastSize * usual_size, along(at, frame.axes[k]));
  return frame;
}

}  // namespace delquad
