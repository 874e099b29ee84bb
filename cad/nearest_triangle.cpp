#include "cad/nearest_triangle.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace delquad::cad {

namespace {

constexpr int kLeafSize = 4;

double distance2(const Vec3& low, const Vec3& high, const Vec3& x) {
  const Vec3 d{std::max({low.x - x.x, 0.0, x.x - high.x}), std::max({low.y - x.y, 0.0, x.y - high.y}),
               std::max({low.z - x.z, 0.0, x.z - high.z})};
  return dot(d, d);
}

/// How far along from a to b the point nearest to x lies, in [0, 1].
double nearest_fraction(const Vec3& a, const Vec3& b, const Vec3& x) {
  const Vec3 d = b - a;
  const double length2 = dot(d, d);
  return length2 > 0 ? std::clamp(dot(x - a, d) / length2, 0.0, 1.0) : 0;
}

}  // namespace

std::array<double, 3> nearest_weights(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& x) {
  const Vec3 normal = cross(b - a, c - a);
  const double area2 = dot(normal, normal);
  if (area2 > 0) {
    const double wa = dot(cross(c - b, x - b), normal) / area2, wb = dot(cross(a - c, x - c), normal) / area2;
    if (wa >= 0 && wb >= 0 && wa + wb <= 1) return {wa, wb, 1 - wa - wb};
  }
  const std::array<Vec3, 3> p{a, b, c};
  std::array<double, 3> best{};
  double best2 = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    const double t = nearest_fraction(p[k], p[next], x);
    const Vec3 d = p[k] + t * (p[next] - p[k]) - x;
    if (dot(d, d) >= best2) continue;
    best2 = dot(d, d);
    best = {};
    best[k] = 1 - t;
    best[next] = t;
  }
  return best;
}

NearestTriangle::NearestTriangle(std::vector<Vec3> points, std::vector<std::array<int, 3>> triangles)
    : points_(std::move(points)), triangles_(std::move(triangles)) {
  if (!triangles_.empty()) build(0, static_cast<int>(triangles_.size()));
}

NearestTriangle::Box NearestTriangle::box_of(int begin, int end) const {
  Box box{points_[triangles_[begin][0]], points_[triangles_[begin][0]]};
  for (int t = begin; t < end; ++t) {
    for (const int v : triangles_[t]) {
      const Vec3& p = points_[v];
      box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
      box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
    }
  }
  return box;
}

int NearestTriangle::build(int begin, int end) {
  const int index = static_cast<int>(nodes_.size());
  const Box box = box_of(begin, end);
  nodes_.push_back({box, begin, end, -1});
  if (end - begin <= kLeafSize) return index;

  const Vec3 extent = box.high - box.low;
  double Vec3::*axis = &Vec3::x;
  if (extent.y > extent.*axis) axis = &Vec3::y;
  if (extent.z > extent.*axis) axis = &Vec3::z;
  const auto key = [&](const std::array<int, 3>& t) {
    return std::pair(points_[t[0]].*axis + points_[t[1]].*axis + points_[t[2]].*axis, t);
  };
  const int middle = begin + (end - begin) / 2;
  std::nth_element(triangles_.begin() + begin, triangles_.begin() + middle, triangles_.begin() + end,
                   [&](const auto& s, const auto& t) { return key(s) < key(t); });
  build(begin, middle);
  const int right = build(middle, end);
  nodes_[index].right = right;
  return index;
}

NearestTriangle::Found NearestTriangle::find(const Vec3& x) const {
  Found best{};
  double best2 = std::numeric_limits<double>::infinity();
  std::vector<std::pair<double, int>> stack;
  const auto push = [&](int n) {
    stack.emplace_back(distance2(nodes_[n].box.low, nodes_[n].box.high, x), n);
  };
  push(0);
  while (!stack.empty()) {
    const auto [box2, index] = stack.back();
    stack.pop_back();
    if (box2 >= best2) continue;
    const Node& node = nodes_[index];
    if (node.right >= 0) {
      push(node.right);
      push(index + 1);
      if (stack.back().first > stack[stack.size() - 2].first)
        std::swap(stack.back(), stack[stack.size() - 2]);
      continue;
    }
    for (int t = node.begin; t < node.end; ++t) {
      const auto& v = triangles_[t];
      const Vec3 &a = points_[v[0]], &b = points_[v[1]], &c = points_[v[2]];
      const auto w = nearest_weights(a, b, c, x);
      const Vec3 d = w[0] * a + w[1] * b + w[2] * c - x;
      if (dot(d, d) >= best2) continue;
      best2 = dot(d, d);
      best = {v, w};
    }
  }
  return best;
}

}  // namespace delquad::cad
