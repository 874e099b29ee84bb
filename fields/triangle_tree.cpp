#include "fields/triangle_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "mesh/predicates.h"

namespace delquad {

namespace {

constexpr int kLeafSize = 4;

Vec2 nearest_on_segment(Vec2 a, Vec2 b, Vec2 u) {
  const Vec2 d = b - a;
  const double length2 = dot(d, d);
  const double t = length2 > 0 ? std::clamp(dot(u - a, d) / length2, 0.0, 1.0) : 0;
  return a + t * d;
}

double box_distance2(Vec2 low, Vec2 high, Vec2 u) {
  const double dx = std::max({low.x - u.x, 0.0, u.x - high.x});
  const double dy = std::max({low.y - u.y, 0.0, u.y - high.y});
  return dx * dx + dy * dy;
}

bool contains(const TriPatch& tri, int t, Vec2 u) {
  const auto& [i, j, k] = tri.triangles[t];
  const Vec2 a = tri.points[i], b = tri.points[j], c = tri.points[k];
  return orient2d(a, b, u) >= 0 && orient2d(b, c, u) >= 0 && orient2d(c, a, u) >= 0;
}

}  // namespace

TriangleTree::TriangleTree(const TriPatch& tri) : order_(tri.triangles.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  if (!order_.empty()) build(tri, 0, static_cast<int>(order_.size()));
}

int TriangleTree::build(const TriPatch& tri, int begin, int end) {
  const int index = static_cast<int>(nodes_.size());
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Node node{{kInf, kInf}, {-kInf, -kInf}, begin, end, -1};
  for (int i = begin; i < end; ++i) {
    for (const int v : tri.triangles[order_[i]]) {
      const Vec2 p = tri.points[v];
      node.low = {std::min(node.low.x, p.x), std::min(node.low.y, p.y)};
      node.high = {std::max(node.high.x, p.x), std::max(node.high.y, p.y)};
    }
  }
  nodes_.push_back(node);
  if (end - begin <= kLeafSize) return index;

  const bool by_x = node.high.x - node.low.x > node.high.y - node.low.y;
  const auto key = [&](int t) {
    double sum = 0;
    for (const int v : tri.triangles[t]) sum += by_x ? tri.points[v].x : tri.points[v].y;
    return std::pair(sum, t);
  };
  const int middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](int a, int b) { return key(a) < key(b); });
  build(tri, begin, middle);
  const int right = build(tri, middle, end);
  nodes_[index].right = right;
  return index;
}

int TriangleTree::containing(const TriPatch& tri, Vec2 u) const {
  int found = -1;
  std::vector<int> stack;
  if (!nodes_.empty()) stack.push_back(0);
  while (!stack.empty()) {
    const int index = stack.back();
    stack.pop_back();
    const Node& node = nodes_[index];
    if (box_distance2(node.low, node.high, u) > 0) continue;
    if (node.right >= 0) {
      stack.push_back(node.right);
      stack.push_back(index + 1);
      continue;
    }
    for (int i = node.begin; i < node.end; ++i) {
      const int t = order_[i];
      if ((found < 0 || t < found) && contains(tri, t, u)) found = t;
    }
  }
  return found;
}

TriangleTree::Nearest TriangleTree::nearest(const TriPatch& tri, Vec2 u) const {
  Nearest best{-1, u};
  double best2 = std::numeric_limits<double>::infinity();
  std::vector<std::pair<double, int>> stack;
  const auto push = [&](int index) {
    stack.emplace_back(box_distance2(nodes_[index].low, nodes_[index].high, u), index);
  };
  push(0);
  while (!stack.empty()) {
    const auto [distance2, index] = stack.back();
    stack.pop_back();
    if (distance2 > best2) continue;
    const Node& node = nodes_[index];
    if (node.right >= 0) {
      push(node.right);
      push(index + 1);
      if (stack.back().first > stack[stack.size() - 2].first)
        std::swap(stack.back(), stack[stack.size() - 2]);
      continue;
    }
    for (int i = node.begin; i < node.end; ++i) {
      const int t = order_[i];
      const bool inside = contains(tri, t, u);
      for (int k = 0; k < 3; ++k) {
        const auto& v = tri.triangles[t];
        const Vec2 p = inside ? u : nearest_on_segment(tri.points[v[k]], tri.points[v[(k + 1) % 3]], u);
        const double d2 = dot(p - u, p - u);
        if (best.triangle < 0 || d2 < best2 || (d2 == best2 && t < best.triangle)) {
          best = {t, p};
          best2 = d2;
        }
      }
    }
  }
  return best;
}

}  // namespace delquad
