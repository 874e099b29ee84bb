#include "fields/triangle_tree.h"

#include <limits>
#include <vector>

#include "base/predicates.h"
#include "base/segment.h"

namespace delquad {

namespace {

bool contains(const TriPatch& tri, int t, Vec2 u) {
  const auto& [i, j, k] = tri.triangles[t];
  const Vec2 a = tri.points[i], b = tri.points[j], c = tri.points[k];
  return orient2d(a, b, u) >= 0 && orient2d(b, c, u) >= 0 && orient2d(c, a, u) >= 0;
}

BoxTree<Vec2> boxes_of(const TriPatch& tri) {
  std::vector<Box<Vec2>> boxes;
  boxes.reserve(tri.triangles.size());
  for (const auto& [a, b, c] : tri.triangles)
    boxes.push_back(Box<Vec2>::around({tri.points[a], tri.points[b], tri.points[c]}));
  return BoxTree<Vec2>(boxes);
}

}  // namespace

TriangleTree::TriangleTree(const TriPatch& tri) : tree_(boxes_of(tri)) {}

int TriangleTree::containing(const TriPatch& tri, Vec2 u) const {
  int found = -1;
  tree_.nearest(u, 0.0, [&](int t) {
    if ((found < 0 || t < found) && contains(tri, t, u)) found = t;
  });
  return found;
}

TriangleTree::Nearest TriangleTree::nearest(const TriPatch& tri, Vec2 u) const {
  Nearest best{-1, u};
  double best2 = std::numeric_limits<double>::infinity();
  tree_.nearest(u, best2, [&](int t) {
    const bool inside = contains(tri, t, u);
    for (int k = 0; k < 3; ++k) {
      const auto& v = tri.triangles[t];
      const Vec2 p = inside ? u : nearest_on_segment(u, tri.points[v[k]], tri.points[v[(k + 1) % 3]]);
      const double d2 = dot(p - u, p - u);
      if (best.triangle < 0 || d2 < best2 || (d2 == best2 && t < best.triangle)) {
        best = {t, p};
        best2 = d2;
      }
    }
  });
  return best;
}

}  // namespace delquad
