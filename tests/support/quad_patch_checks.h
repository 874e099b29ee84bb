// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "delquad/fields.h"
#include "delquad/mesh.h"
#include "geometry/mesh/quad_corners.h"
#include "geometry/mesh/quad_topology.h"

/// Checks that must hold for any quad mesh of a patch, whatever its geometry.
namespace delquad::testing_support {

/// Violations, one line each: indices, repeated vertices, points that nothing uses, sides used twice in one
/// direction or by more than two elements. Further ones are a boundary that is not the given one, boundary
/// points that moved, and V - E + F not `euler` (1 - holes for one component).
inline std::vector<std::string> check_quad_patch(const QuadPatch& mesh, const PatchBoundary& boundary,
                                                 int euler) {
  std::vector<std::string> wrong;
  const int n = static_cast<int>(mesh.points.size());
  std::set<std::pair<int, int>> sides;
  std::vector<char> used(mesh.points.size(), 0);
  const auto add = [&](const auto& element) {
    for (std::size_t k = 0; k < element.size(); ++k) {
      const int a = element[k], b = element[(k + 1) % element.size()];
      if (a < 0 || a >= n) {
        wrong.push_back("index " + std::to_string(a) + " out of range");
        return;
      }
      used[a] = 1;
      if (std::count(element.begin(), element.end(), a) != 1)
        wrong.push_back("repeated vertex " + std::to_string(a));
      if (!sides.emplace(a, b).second) {
        wrong.push_back("side " + std::to_string(a) + "-" + std::to_string(b) +
                        " used twice in one direction");
      }
    }
  };
  for (const auto& q : mesh.quads) add(q);
  for (const auto& t : mesh.triangles) add(t);
  for (int i = 0; i < n; ++i) {
    if (used[i] == 0) wrong.push_back("point " + std::to_string(i) + " is not used");
  }
  std::set<std::pair<int, int>> outline, expected;
  int edges = 0;
  for (const auto& [a, b] : sides) {
    const bool outer = !sides.contains({b, a});
    if (outer) outline.emplace(a, b);
    if (outer || a < b) ++edges;
  }
  for (const auto& e : boundary.edges) expected.emplace(e[0], e[1]);
  if (outline != expected) wrong.push_back("the boundary is not the given one");
  if (mesh.n_boundary != static_cast<int>(boundary.points.size()) ||
      !std::equal(boundary.points.begin(), boundary.points.end(), mesh.points.begin())) {
    wrong.push_back("boundary points moved");
  }
  const int found = n - edges + static_cast<int>(mesh.quads.size() + mesh.triangles.size());
  if (found != euler)
    wrong.push_back("V - E + F is " + std::to_string(found) + ", not " + std::to_string(euler));
  return wrong;
}

/// How many loops the boundary has.
inline int count_loops(const PatchBoundary& boundary) {
  std::map<int, int> next;
  for (const auto& e : boundary.edges) next[e[0]] = e[1];
  int loops = 0;
  while (!next.empty()) {
    ++loops;
    for (auto at = next.begin(); at != next.end();) {
      const int to = at->second;
      next.erase(at);
      at = next.find(to);
    }
  }
  return loops;
}

/// The findings of check_quad_patch(), as failures of the test.
inline void expect_sound(const QuadPatch& mesh, const PatchBoundary& boundary) {
  const auto wrong = check_quad_patch(mesh, boundary, 2 - count_loops(boundary));
  EXPECT_TRUE(wrong.empty()) << wrong.front();
}

/// Least sine over all corners: eta worst = 2/pi asin of it.
inline double worst_sine(const QuadTopology& mesh) {
  double least = 1;
  for (int e = 0; e < mesh.element_slots(); ++e) least = std::min(least, least_sine(mesh, e));
  return least;
}
inline double worst_sine(const QuadPatch& mesh) { return worst_sine(QuadTopology(mesh)); }

/// For the quads' sides inside, the least length over the longer of the size (the least at the ends) and the
/// quad's longest side. Left out are quads in narrow places: at vertices of quads that reach from one part of
/// the boundary to another.
inline double least_room(const QuadPatch& mesh, const ParametricSize& size) {
  std::set<std::pair<int, int>> sides;
  for (const auto& q : mesh.quads)
    for (int k = 0; k < 4; ++k) sides.emplace(q[k], q[(k + 1) % 4]);
  std::set<int> on_boundary, narrow;
  for (const auto& [a, b] : sides)
    if (!sides.contains({b, a})) on_boundary.insert({a, b});
  for (const auto& q : mesh.quads) {
    int vertices = 0, outer = 0;
    for (int k = 0; k < 4; ++k) {
      vertices += static_cast<int>(on_boundary.count(q[k]));
      outer += !sides.contains({q[(k + 1) % 4], q[k]});
    }
    if (vertices <= outer + 1) continue;
    for (const int v : q)
      if (on_boundary.contains(v)) narrow.insert(v);
  }
  double least = 1;
  int hint = -1;
  for (const auto& q : mesh.quads) {
    if (std::any_of(q.begin(), q.end(), [&](int v) { return narrow.contains(v); })) continue;
    const auto length = [&](int k) { return norm(mesh.points[q[(k + 1) % 4]] - mesh.points[q[k]]); };
    const double longest = std::max({length(0), length(1), length(2), length(3)});
    for (int k = 0; k < 4; ++k) {
      const int a = q[k], b = q[(k + 1) % 4];
      if (!sides.contains({b, a})) continue;
      const double delta = std::min(size.at(mesh.points[a], hint), size.at(mesh.points[b], hint));
      least = std::min(least, length(k) / std::max(delta, longest));
    }
  }
  return least;
}

}  // namespace delquad::testing_support
