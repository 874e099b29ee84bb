// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/volume/find_bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/disjoint_sets.h"
#include "base/located.h"
#include "base/text.h"
#include "geometry/mesh/half_edges.h"

namespace delquad {

namespace {

/// Each quad has two sides: 2 q is seen by the space that its normal leaves, 2 q + 1 by the other one.
struct Shells {
  std::vector<int> of_side;      ///< shell of each side; connected sides bound one space
  std::vector<int> part;         ///< connected part of the skin, by shell
  std::vector<double> volume;    ///< by shell; negative: the shell bounds its space from inside
  std::vector<int> normals_out;  ///< by shell: sides that the normals leave, less the others
};

/// Sorts the sides of quads at an edge counterclockwise around it.
std::vector<HalfEdge> around_edge(const Mesh& skin, std::span<const HalfEdge> sides) {
  std::vector<HalfEdge> sorted(sides.begin(), sides.end());
  if (sides.size() < 3) return sorted;
  const Vec3 at = skin.points[sides[0].lo], along = skin.points[sides[0].hi] - at;
  const auto across = [&](const HalfEdge& side) {
    const Vec3 v = middle_of(skin, side.element) - at;
    return v - dot(v, along) / dot(along, along) * along;
  };
  const Vec3 x = across(sides[0]), y = (1 / norm(along)) * cross(along, x);
  std::ranges::stable_sort(sorted, {}, [&](const HalfEdge& side) {
    const Vec3 v = across(side);
    const double angle = std::atan2(dot(v, y), dot(v, x));
    return angle < 0 ? angle + 2 * std::numbers::pi : angle;
  });
  return sorted;
}

Shells find_shells(const Mesh& skin) {
  const int n = static_cast<int>(skin.quads.size());
  DisjointSets spaces(2 * n), parts(n);
  const std::vector<HalfEdge> all = sorted_half_edges(skin);
  for_each_edge(all, [&](std::span<const HalfEdge> sides) {
    if (sides.size() == 1)
      refuse("the skin is open at the edge from {} to {}: a volume needs a closed skin",
             show_point(skin.points[sides[0].lo]), show_point(skin.points[sides[0].hi]));
    const std::vector<HalfEdge> around = around_edge(skin, sides);
    for (std::size_t i = 0; i < around.size(); ++i) {
      const HalfEdge &one = around[i], &next = around[(i + 1) % around.size()];
      // The normal of a quad that runs from lo to hi points counterclockwise around the edge.
      spaces.join(2 * one.element + one.forward, 2 * next.element + !next.forward);
      parts.join(one.element, next.element);
    }
  });
  Shells shells;
  shells.of_side.resize(2 * n);
  std::vector<int> number(2 * n, -1);
  for (int side = 0; side < 2 * n; ++side) {
    int& shell = number[spaces.root(side)];
    if (shell < 0) {
      shell = static_cast<int>(shells.volume.size());
      shells.part.push_back(parts.root(side / 2));
      shells.volume.push_back(0);
      shells.normals_out.push_back(0);
    }
    shells.of_side[side] = shell;
    const auto& q = skin.quads[side / 2];
    const Vec3 &a = skin.points[q[0]], b = skin.points[q[1]], c = skin.points[q[2]], d = skin.points[q[3]];
    const Vec3 o = skin.points[0];
    const double cone = dot(cross(b - a, c - a) + cross(c - a, d - a), middle_of(skin, side / 2) - o) / 6;
    shells.volume[shell] += side % 2 == 0 ? cone : -cone;
    shells.normals_out[shell] += side % 2 == 0 ? 1 : -1;
  }
  return shells;
}

/// Returns whether a shell of positive volume encloses a point, by the solid angle of its quads.
bool encloses(const Mesh& skin, const Shells& shells, int shell, const Vec3& x) {
  double angle = 0;
  for (std::size_t side = 0; side < shells.of_side.size(); ++side) {
    if (shells.of_side[side] != shell) continue;
    const auto& q = skin.quads[side / 2];
    for (const int k : {1, 2}) {
      const Vec3 a = skin.points[q[0]] - x, b = skin.points[q[k]] - x, c = skin.points[q[k + 1]] - x;
      const double la = norm(a), lb = norm(b), lc = norm(c);
      const double part = 2 * std::atan2(dot(a, cross(b, c)),
                                         la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
      angle += side % 2 == 0 ? part : -part;
    }
  }
  return angle > 2 * std::numbers::pi;
}

}  // namespace

Vec3 middle_of(const Mesh& mesh, int q) {
  Vec3 sum;
  for (const int v : mesh.quads[q]) sum = sum + 0.25 * mesh.points[v];
  return sum;
}

std::vector<Body> find_bodies(const Mesh& skin, ReadNotes* notes) {
  const Shells shells = find_shells(skin);
  const int n = static_cast<int>(shells.volume.size());
  std::vector<int> first(n, -1), container(n, -1);
  for (int side = static_cast<int>(shells.of_side.size()); side-- > 0;) first[shells.of_side[side]] = side;
  // The least shell of another part around each shell.
  for (int s = 0; s < n; ++s)
    for (int around = 0; around < n; ++around)
      if (shells.volume[around] > std::abs(shells.volume[s]) && shells.part[around] != shells.part[s] &&
          (container[s] < 0 || shells.volume[around] < shells.volume[container[s]]) &&
          encloses(skin, shells, around, skin.points[skin.quads[first[s] / 2][0]]))
        container[s] = around;
  std::vector<int> body_of(n, -1);
  std::vector<Body> bodies;
  for (int s = 0; s < n; ++s) {
    if (!(shells.volume[s] > 0)) continue;
    if (container[s] >= 0 && shells.normals_out[s] < 0) {
      if (notes != nullptr)
        notes->push_back(fmt::format("the space at {} is a cavity, since normals point into it",
                                     show_point(middle_of(skin, first[s] / 2))));
      continue;
    }
    body_of[s] = static_cast<int>(bodies.size());
    bodies.emplace_back();
  }
  for (int side = 0; side < static_cast<int>(shells.of_side.size()); ++side) {
    const int shell = shells.of_side[side];
    const int owner = shells.volume[shell] > 0 ? shell : container[shell];
    if (owner >= 0 && body_of[owner] >= 0) bodies[body_of[owner]].push_back({side / 2, side % 2 == 1});
  }
  return bodies;
}

}  // namespace delquad
