#include "geometry/cad/touching_faces.h"

#include <algorithm>
#include <memory>
#include <set>
#include <utility>

#include "base/box.h"
#include "base/cancel.h"
#include "mesh/half_edges.h"
#include "mesh/nearest_triangle.h"

namespace delquad::cad {

namespace {

/// The triangles of a face, and the bodies that have it (ascending).
struct Patch {
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> bodies;
  Box<Vec3> box;
};

class TouchFinder {
 public:
  TouchFinder(const SurfaceModel& model, const std::vector<std::vector<int>>& bodies, double deflection,
              double tolerance)
      : model_(model), deflection_(deflection), tolerance_(tolerance), patches_(model.fine.regions.size()) {
    for (int b = 0; b < std::ssize(bodies); ++b)
      for (const int f : bodies[b])
        if (patches_[f].bodies.empty() || patches_[f].bodies.back() != b) patches_[f].bodies.push_back(b);
    for (std::size_t t = 0; t < model.fine.triangles.size(); ++t)
      patches_[model.fine.triangle_region[t]].triangles.push_back(model.fine.triangles[t]);
    for (Patch& patch : patches_) set_box(patch);
    find_neighbours();
    trees_.resize(patches_.size());
  }

  std::vector<std::array<int, 2>> find() {
    std::vector<int> order;
    for (int f = 0; f < std::ssize(patches_); ++f)
      if (!patches_[f].triangles.empty()) order.push_back(f);
    std::ranges::sort(order, {}, [&](int f) { return patches_[f].box.low.x; });
    std::vector<std::array<int, 2>> pairs;
    for (std::size_t i = 0; i < order.size(); ++i) {
      check_cancelled();
      const Patch& first = patches_[order[i]];
      for (std::size_t j = i + 1; j < order.size() && patches_[order[j]].box.low.x <= first.box.high.x; ++j) {
        const int f = std::min(order[i], order[j]), g = std::max(order[i], order[j]);
        if (are_apart(f, g)) continue;
        if (lies_on(f, g) || lies_on(g, f)) pairs.push_back({f, g});
      }
    }
    std::ranges::sort(pairs);
    return pairs;
  }

 private:
  void set_box(Patch& patch) const {
    if (patch.triangles.empty()) return;
    const std::vector<Vec3>& points = model_.fine.points;
    patch.box = Box<Vec3>::around({points[patch.triangles[0][0]]});
    for (const auto& triangle : patch.triangles)
      for (const int v : triangle) patch.box.add(points[v]);
    const Vec3 more{deflection_, deflection_, deflection_};
    patch.box = {patch.box.low - more, patch.box.high + more};
  }

  /// Faces that share a side: what lies near it lies near both.
  void find_neighbours() {
    const std::vector<HalfEdge> sides = sorted_half_edges(model_.fine);
    for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
      for (const HalfEdge& a : edge)
        for (const HalfEdge& b : edge) {
          const int f = model_.fine.triangle_region[a.element], g = model_.fine.triangle_region[b.element];
          if (f < g) neighbours_.insert({f, g});
        }
    });
  }

  /// By their boxes, in one body, or neighbours.
  bool are_apart(int f, int g) const {
    const Patch &p = patches_[f], &q = patches_[g];
    if (!p.box.overlaps(q.box) || neighbours_.contains({f, g})) return true;
    return std::ranges::any_of(p.bodies, [&](int b) { return std::ranges::binary_search(q.bodies, b); });
  }

  /// Whether some place inside a triangle of f is a place of g.
  bool lies_on(int f, int g) {
    constexpr double kNear = 2.0 / 3, kFar = 1.0 / 6;
    const std::vector<Vec3>& x = model_.fine.points;
    for (const auto& [a, b, c] : patches_[f].triangles) {
      if (!Box<Vec3>::around({x[a], x[b], x[c]}).overlaps(patches_[g].box)) continue;
      for (const Vec3& place : {1.0 / 3 * (x[a] + x[b] + x[c]), kNear * x[a] + kFar * (x[b] + x[c]),
                                kNear * x[b] + kFar * (x[c] + x[a]), kNear * x[c] + kFar * (x[a] + x[b])})
        if (patches_[g].box.distance2(place) == 0 && is_on(model_.projector->to_face(f, place), g))
          return true;
    }
    return false;
  }

  /// On points of its own: as many as it has corners.
  std::unique_ptr<NearestTriangle> tree_of(int g) const {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    for (const auto& triangle : patches_[g].triangles) {
      const int n = static_cast<int>(points.size());
      for (const int v : triangle) points.push_back(model_.fine.points[v]);
      triangles.push_back({n, n + 1, n + 2});
    }
    return std::make_unique<NearestTriangle>(std::move(points), std::move(triangles));
  }

  bool is_on(const Vec3& x, int g) {
    if (!trees_[g]) trees_[g] = tree_of(g);
    // The triangles tell where the face is, its surface how far.
    if (trees_[g]->find(x, 2 * deflection_).triangle < 0) return false;
    return norm(model_.projector->to_face(g, x) - x) <= tolerance_;
  }

  const SurfaceModel& model_;
  double deflection_, tolerance_;
  std::vector<Patch> patches_;  ///< by face
  std::set<std::pair<int, int>> neighbours_;
  std::vector<std::unique_ptr<NearestTriangle>> trees_;
};

}  // namespace

std::vector<std::array<int, 2>> touching_faces(const SurfaceModel& model,
                                               const std::vector<std::vector<int>>& bodies, double deflection,
                                               double tolerance) {
  if (bodies.size() < 2) return {};
  return TouchFinder(model, bodies, deflection, tolerance).find();
}

}  // namespace delquad::cad
