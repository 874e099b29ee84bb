// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/embedded/section_path.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <queue>

namespace delquad {

namespace {

/// Below this part of its length, the cross product of a direction and a normal says nothing.
constexpr double kParallel = 1e-3;

/// Goes through the section from place to place, the nearest to the start first.
class SectionSearch {
 public:
  SectionSearch(const Mesh& mesh, const SurfaceEditor& editor, const SectionPlane& plane, int a, int b,
                double snap)
      : mesh_(mesh), editor_(editor), plane_(plane), a_(a), b_(b), snap_(snap) {}

  std::vector<SectionPlace> run() {
    const double longest = kMostDetour * norm(mesh_.points[b_] - mesh_.points[a_]);
    reach({a_, -1}, 0, {-1, -1});
    while (!queue_.empty()) {
      const auto [way, place] = queue_.top();
      queue_.pop();
      if (way > longest) break;
      if (place == SectionPlace{b_, -1}) return way_to(place);
      if (reached_.at(place).way < way) continue;
      leave(place, way);
    }
    return {};
  }

 private:
  struct Reached {
    double way;
    SectionPlace from;
  };

  /// The sign alone decides where the section runs.
  int side(int v) const {
    if (v == a_ || v == b_) return 0;
    const double height = plane_.height(mesh_.points[v]);
    return height > snap_ ? 1 : height < -snap_ ? -1 : 0;
  }

  void reach(const SectionPlace& place, double way, const SectionPlace& from) {
    const auto [at, is_new] = reached_.try_emplace(place, Reached{way, from});
    if (!is_new && at->second.way <= way) return;
    at->second = {way, from};
    queue_.emplace(way, place);
  }

  void leave(const SectionPlace& place, double way) {
    const Vec3 x = position(mesh_, plane_, place);
    std::vector<int> triangles;
    if (place.second < 0)
      triangles.assign(editor_.triangles_at(place.first).begin(), editor_.triangles_at(place.first).end());
    else
      editor_.find_triangles_on(place.first, place.second, triangles);
    const auto go = [&](const SectionPlace& to) {
      if (to != place) reach(to, way + norm(position(mesh_, plane_, to) - x), place);
    };
    for (const int t : triangles)
      for (int k = 0; k < 3; ++k) {
        const int v = mesh_.triangles[t][k], w = mesh_.triangles[t][(k + 1) % 3];
        if (side(v) == 0) go({v, -1});
        if (side(v) * side(w) < 0) go(std::minmax(v, w));
      }
  }

  std::vector<SectionPlace> way_to(SectionPlace place) const {
    std::vector<SectionPlace> way;
    for (; place.first >= 0; place = reached_.at(place).from) way.push_back(place);
    std::ranges::reverse(way);
    return way;
  }

  const Mesh& mesh_;
  const SurfaceEditor& editor_;
  const SectionPlane& plane_;
  int a_, b_;
  double snap_;
  std::map<SectionPlace, Reached> reached_;
  using Waiting = std::pair<double, SectionPlace>;
  std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> queue_;
};

}  // namespace

SectionPlane section_plane(const Mesh& mesh, int a, int b, const Vec3& normal) {
  const Vec3 d = mesh.points[b] - mesh.points[a];
  Vec3 across = cross(d, normal);
  if (norm(across) < kParallel * norm(d)) {  // such as opposite points of a sphere: any plane will do
    const bool along_x = std::abs(d.x) > std::abs(d.y);
    across = cross(d, along_x ? Vec3{0, 1, 0} : Vec3{1, 0, 0});
  }
  return {mesh.points[a], (1 / norm(across)) * across};
}

Vec3 position(const Mesh& mesh, const SectionPlane& plane, const SectionPlace& place) {
  const Vec3& a = mesh.points[place.first];
  if (place.second < 0) return a;
  const Vec3& b = mesh.points[place.second];
  const double from = std::abs(plane.height(a)), to = std::abs(plane.height(b));
  return a + from / (from + to) * (b - a);
}

std::vector<SectionPlace> section_path(const Mesh& mesh, const SurfaceEditor& editor,
                                       const SectionPlane& plane, int a, int b, double snap) {
  return SectionSearch(mesh, editor, plane, a, b, snap).run();
}

}  // namespace delquad
