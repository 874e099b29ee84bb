#include "fields/background_mesh.h"

#include <algorithm>
#include <utility>

#include "base/predicates.h"
#include "delquad/error.h"
#include "fields/refine_patch.h"
#include "fields/triangle_tree.h"

namespace delquad {

namespace {

// A walk this long costs more than asking the tree; it also ends the cycles possible where the triangulation
// is not Delaunay (next to boundary edges).
constexpr int kLongestWalk = 100;

/// Gives each vertex on the boundary the edge it lies on.
std::vector<BackgroundMesh::BoundaryPoint> trace_boundary(const PatchBoundary& patch, const TriPatch& tri) {
  std::vector<int> next(tri.points.size(), -1);
  for (std::size_t t = 0; t < tri.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (tri.neighbours[t][k] < 0) next[tri.triangles[t][(k + 1) % 3]] = tri.triangles[t][(k + 2) % 3];
    }
  }
  std::vector<BackgroundMesh::BoundaryPoint> result(tri.points.size());
  for (const auto& [a, b] : patch.edges) {
    const Vec2 start = patch.points[a], side = patch.points[b] - start;
    const double length = norm(side);
    for (int v = a; v != b; v = next[v]) {
      const double t = norm(tri.points[v] - start) / length;
      result[v] = {patch.point_node[a], patch.point_node[b], t, (1 / length) * side};
    }
  }
  return result;
}

void append(TriPatch& all, const TriPatch& part) {
  const int first_point = static_cast<int>(all.points.size()), first = static_cast<int>(all.triangles.size());
  all.points.insert(all.points.end(), part.points.begin(), part.points.end());
  for (auto v : part.triangles) {
    for (int& i : v) i += first_point;
    all.triangles.push_back(v);
  }
  for (auto n : part.neighbours) {
    for (int& i : n) i = i < 0 ? -1 : i + first;
    all.neighbours.push_back(n);
  }
}

}  // namespace

BackgroundMesh::BackgroundMesh(std::span<const PatchBoundary> patches) {
  if (patches.empty()) throw InputError("the domain has no patch: there is nothing to mesh");
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const TriPatch part = refine_patch(patches[p]);
    const auto boundary = trace_boundary(patches[p], part);
    boundary_.insert(boundary_.end(), boundary.begin(), boundary.end());
    append(tri_, part);
    patch_.resize(tri_.triangles.size(), static_cast<int>(p));
  }
  set_up_search();
}

BackgroundMesh::BackgroundMesh(TriPatch triangulation) : tri_(std::move(triangulation)) {
  patch_.resize(tri_.triangles.size(), 0);
  boundary_.resize(tri_.points.size());
  for (std::size_t t = 0; t < tri_.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (tri_.neighbours[t][k] >= 0) continue;
      const int from = tri_.triangles[t][(k + 1) % 3], to = tri_.triangles[t][(k + 2) % 3];
      const Vec2 side = tri_.points[to] - tri_.points[from];
      boundary_[from] = {from, to, 0, (1 / norm(side)) * side};
    }
  }
  set_up_search();
}

void BackgroundMesh::set_up_search() {
  tree_ = std::make_shared<const TriangleTree>(tri_);
  low_ = high_ = tri_.points.at(0);
  for (const Vec2 p : tri_.points) {
    low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
    high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y)};
  }
  const double reach = norm(high_ - low_);
  low_ += Vec2{-reach, -reach};
  high_ += Vec2{reach, reach};
}

/// NaNs become the lower ends.
Vec2 BackgroundMesh::within_reach(Vec2 u) const {
  const auto clamped = [](double x, double low, double high) { return !(x > low) ? low : std::min(x, high); };
  return {clamped(u.x, low_.x, high_.x), clamped(u.y, low_.y, high_.y)};
}

/// The first triangle that contains u, or -1 where the walk cannot tell: u outside or on the boundary, a
/// vertex, hidden.
int BackgroundMesh::walk(Vec2 u, int hint) const {
  int from = -1, t = hint;
  for (int step = 0; t >= 0 && step < kLongestWalk; ++step) {
    const auto& v = tri_.triangles[t];
    const auto& n = tri_.neighbours[t];
    int zeros = 0, across = 0;
    bool crossed = false;
    for (int k = 0; k < 3 && !crossed; ++k) {
      if (n[k] >= 0 && n[k] == from) continue;
      const int side = orient2d(tri_.points[v[(k + 1) % 3]], tri_.points[v[(k + 2) % 3]], u);
      if (side > 0) continue;
      across = n[k];
      crossed = side < 0;
      zeros += side == 0;
    }
    if (!crossed) {
      if (zeros == 0) return t;
      return zeros == 1 && across >= 0 ? std::min(t, across) : -1;
    }
    from = t;
    t = across;
  }
  return -1;
}

BackgroundMesh::Location BackgroundMesh::locate(Vec2 u, int& hint) const {
  u = within_reach(u);
  int t = walk(u, hint);
  if (t < 0) t = tree_->containing(tri_, u);
  if (t < 0) {
    const auto nearest = tree_->nearest(tri_, u);
    t = nearest.triangle;
    u = nearest.point;
  }
  hint = t;

  const auto& v = tri_.triangles[t];
  Location location{t, {1, 0, 0}};
  double area[3], sum = 0;
  for (int k = 0; k < 3; ++k) {
    area[k] = std::max(0.0, cross(tri_.points[v[(k + 1) % 3]] - u, tri_.points[v[(k + 2) % 3]] - u));
    sum += area[k];
  }
  if (sum > 0) {
    for (int k = 0; k < 3; ++k) location.b[k] = area[k] / sum;
  }
  return location;
}

}  // namespace delquad
