// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/volume/fill_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/disjoint_sets.h"
#include "base/located.h"
#include "base/text.h"
#include "features/volume/hexahedra_steps.h"
#include "geometry/mesh/half_edges.h"
#include "metrics/cells.h"

namespace delquad {

namespace {

/// The boundary of a space on one of its sides. Each quad has two: 2 q is seen by the space that its normal
/// leaves, 2 q + 1 by the other one.
struct Shell {
  int first, part;      ///< first side, and connected part of the skin
  double volume = 0;    ///< negative: the shell bounds its space from inside
  int normals_out = 0;  ///< sides that the normals leave, less the others
};

/// Returns the shell of each side, and all shells.
std::pair<std::vector<int>, std::vector<Shell>> find_shells(const Mesh& skin) {
  const int n = static_cast<int>(skin.quads.size());
  DisjointSets spaces(2 * n), parts(n);
  const std::vector<HalfEdge> all = sorted_half_edges(skin);
  for_each_edge(all, [&](std::span<const HalfEdge> sides) {
    if (sides.size() == 1)
      refuse("the skin is open at the edge from {} to {}: a volume needs a closed skin [unsound-skin]",
             show_point(skin.points[sides[0].lo]), show_point(skin.points[sides[0].hi]));
    const auto middle = [&](const HalfEdge& side) {
      return middle_of(skin.points, skin.quads[side.element]);
    };
    const AngleAround angle(skin.points[sides[0].lo], skin.points[sides[0].hi], middle(sides[0]));
    std::vector<HalfEdge> around(sides.begin(), sides.end());
    std::ranges::stable_sort(around, {}, [&](const HalfEdge& side) { return angle(middle(side)); });
    for (std::size_t i = 0; i < around.size(); ++i) {
      const HalfEdge &one = around[i], &next = around[(i + 1) % around.size()];
      // The normal of a quad that runs from lo to hi points counterclockwise around the edge.
      spaces.join(2 * one.element + one.forward, 2 * next.element + !next.forward);
      parts.join(one.element, next.element);
    }
  });
  const std::vector<int> of_side = spaces.places();
  std::vector<Shell> all_shells;
  for (int side = 0; side < 2 * n; ++side) {
    const int number = of_side[side], q = side / 2, sign = side % 2 == 0 ? 1 : -1;
    if (number == static_cast<int>(all_shells.size())) all_shells.push_back({side, parts.root(q)});
    const auto [a, b, c, d] = corners_of(skin.points, skin.quads[q]);
    const Vec3 middle = middle_of(skin.points, skin.quads[q]) - skin.points[0];
    all_shells[number].volume += sign * dot(cross(b - a, c - a) + cross(c - a, d - a), middle) / 6;
    all_shells[number].normals_out += sign;
  }
  return {of_side, all_shells};
}

/// Returns whether a shell encloses a point off it.
bool encloses(const Mesh& skin, const std::vector<int>& shell_of, int shell, const Vec3& x) {
  Mesh around;
  around.points = skin.points;
  for (std::size_t side = 0; side < shell_of.size(); ++side)
    if (shell_of[side] == shell) around.quads.push_back(skin.quads[side / 2]);
  return Skin(around).contains(x);
}

}  // namespace

std::vector<Body> find_bodies(const Mesh& skin, ReadNotes* notes) {
  const auto [of_side, shells] = find_shells(skin);
  const int n = static_cast<int>(shells.size());
  // The least shell of another part around each shell.
  std::vector<int> container(n, -1), body_of(n, -1);
  for (int s = 0; s < n; ++s)
    for (int around = 0; around < n; ++around)
      if (shells[around].volume > std::abs(shells[s].volume) && shells[around].part != shells[s].part &&
          (container[s] < 0 || shells[around].volume < shells[container[s]].volume) &&
          encloses(skin, of_side, around, middle_of(skin.points, skin.quads[shells[s].first / 2])))
        container[s] = around;
  std::vector<Body> bodies;
  for (int s = 0; s < n; ++s) {
    if (!(shells[s].volume > 0)) continue;
    if (container[s] < 0 || shells[s].normals_out >= 0) {
      body_of[s] = static_cast<int>(bodies.size());
      bodies.emplace_back();
    } else if (notes != nullptr) {
      notes->push_back(fmt::format("the space at {} is a cavity, since normals point into it",
                                   show_point(middle_of(skin.points, skin.quads[shells[s].first / 2]))));
    }
  }
  for (int side = 0; side < static_cast<int>(of_side.size()); ++side) {
    const int shell = of_side[side], owner = shells[shell].volume > 0 ? shell : container[shell];
    if (owner >= 0 && body_of[owner] >= 0) bodies[body_of[owner]].push_back({side / 2, side % 2 == 1});
  }
  return bodies;
}

}  // namespace delquad
