// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "base/predicates.h"
#include "delquad/mesh.h"
#include "geometry/mesh/quad_topology.h"

namespace delquad {

/// Returns the errors of the triangulation, one line each: ranges, orientation, neighbors that do not agree.
inline std::vector<std::string> check_invariants(const TriPatch& tri) {
  std::vector<std::string> wrong;
  const int n_points = static_cast<int>(tri.points.size()), n = static_cast<int>(tri.triangles.size());
  for (int t = 0; t < n; ++t) {
    const auto& v = tri.triangles[t];
    bool in_range = true;
    for (int k = 0; k < 3; ++k)
      in_range = in_range && v[k] >= 0 && v[k] < n_points && tri.neighbours[t][k] < n;
    if (!in_range) {
      wrong.push_back(fmt::format("triangle {}: an index is out of range", t));
      continue;
    }
    if (orient2d(tri.points[v[0]], tri.points[v[1]], tri.points[v[2]]) <= 0) {
      wrong.push_back(fmt::format("triangle {}: not counterclockwise", t));
    }
    for (int k = 0; k < 3; ++k) {
      const int o = tri.neighbours[t][k];
      if (o < 0) continue;
      bool mutual = false;
      for (int j = 0; j < 3; ++j) {
        mutual = mutual || (tri.neighbours[o][j] == t && tri.triangles[o][(j + 1) % 3] == v[(k + 2) % 3] &&
                            tri.triangles[o][(j + 2) % 3] == v[(k + 1) % 3]);
      }
      if (!mutual) wrong.push_back(fmt::format("triangles {} and {}: neighbours that do not agree", t, o));
    }
  }
  return wrong;
}

/// Returns the errors, one line each; empty when the mesh is sound.
inline std::vector<std::string> check_invariants(const QuadTopology& mesh) {
  std::vector<std::string> wrong;
  const auto half_edge = [](int h) { return "half-edge " + std::to_string(h); };
  std::vector<int> count(mesh.vertex_slots(), 0);
  for (int h = 0; h < 4 * mesh.element_slots(); ++h) {
    if (mesh.origin(h) < 0) continue;
    ++count[mesh.origin(h)];
    if (!mesh.vertex_alive(mesh.origin(h))) wrong.push_back(half_edge(h) + " leaves a dead vertex");
    const int t = mesh.twin(h);
    if (t < 0) {
      if (!mesh.on_boundary(mesh.origin(h)) || !mesh.on_boundary(mesh.target(h)))
        wrong.push_back(half_edge(h) + " is open inside");
      if (mesh.out(mesh.origin(h)) != h)
        wrong.push_back(half_edge(h) + " is not its boundary vertex's first");
    } else if (mesh.twin(t) != h || mesh.origin(t) != mesh.target(h) || mesh.target(t) != mesh.origin(h)) {
      wrong.push_back(half_edge(h) + " and its twin disagree");
    }
  }
  if (!wrong.empty()) return wrong;
  for (int v = 0; v < mesh.vertex_slots(); ++v) {
    if (!mesh.vertex_alive(v)) continue;
    int fan = 0;
    mesh.for_each_out(v, [&](int h) { fan += mesh.origin(h) == v ? 1 : count[v] + 1; });
    if (fan != count[v] || mesh.valence(v) != count[v])
      wrong.push_back("vertex " + std::to_string(v) + " has " + std::to_string(count[v]) + " elements, " +
                      std::to_string(fan) + " around it, and says " + std::to_string(mesh.valence(v)));
  }
  return wrong;
}

}  // namespace delquad
