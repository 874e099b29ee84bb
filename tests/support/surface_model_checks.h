// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "geometry/mesh/check_invariants.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/surface/surface_model.h"

namespace delquad::testing_support {

/// Chains: each line begins where the one before it ended, and only their ends are corners.
inline void check_chains(const SurfaceModel& model, std::vector<std::string>& wrong) {
  const Mesh& mesh = model.fine;
  std::map<int, std::vector<std::array<int, 2>>> chains;
  for (size_t i = 0; i < mesh.lines.size(); ++i) chains[mesh.line_curve[i]].push_back(mesh.lines[i]);
  if (chains.size() != mesh.curves.size()) wrong.push_back("a curve without lines");
  std::set<int> ends;
  std::map<int, int> lines_at;
  for (const auto& [curve, chain] : chains) {
    for (size_t k = 1; k < chain.size(); ++k) {
      if (chain[k - 1][1] != chain[k][0]) wrong.push_back("curve " + std::to_string(curve) + " is torn");
      if (std::binary_search(model.corners.begin(), model.corners.end(), chain[k][0])) {
        wrong.push_back("curve " + std::to_string(curve) + " runs through a corner");
      }
    }
    const int first = chain.front()[0], last = chain.back()[1];
    if (first != last) ends.insert({first, last});
    for (const auto& [a, b] : chain) {
      ++lines_at[a];
      ++lines_at[b];
    }
  }
  for (const auto& [point, n] : lines_at) {
    if (n != 2) ends.insert(point);
  }
  for (const int point : ends) {
    if (!std::binary_search(model.corners.begin(), model.corners.end(), point)) {
      wrong.push_back("curves end at point " + std::to_string(point) + ", which is no corner");
    }
  }
  for (const int point : model.corners) {
    if (!lines_at.contains(point)) wrong.push_back("no curve at corner " + std::to_string(point));
  }
}

/// Faces hang together across sides that are none of these lines.
inline void check_faces(const Mesh& mesh, const std::map<std::array<int, 2>, int>& lines,
                        std::vector<std::string>& wrong) {
  std::vector<int> part(mesh.triangles.size());
  for (size_t t = 0; t < part.size(); ++t) part[t] = static_cast<int>(t);
  const auto find = [&](int t) {
    while (part[t] != t) t = part[t] = part[part[t]];
    return t;
  };
  for_each_edge(sorted_half_edges(mesh), [&](std::span<const HalfEdge> edge) {
    if (edge.size() == 2 && !lines.contains({edge[0].lo, edge[0].hi}))
      part[find(edge[0].element)] = find(edge[1].element);
  });
  std::map<int, std::set<int>> parts;
  for (size_t t = 0; t < part.size(); ++t) parts[mesh.triangle_region[t]].insert(find(static_cast<int>(t)));
  for (const auto& [face, some] : parts) {
    if (some.size() > 1) wrong.push_back("face " + std::to_string(face) + " is in pieces");
  }
  if (parts.size() != mesh.regions.size()) wrong.push_back("a face without triangles");
}

/// Returns breaks of the promises of SurfaceModel, one line each.
inline std::vector<std::string> violations(const SurfaceModel& model) {
  const Mesh& mesh = model.fine;
  std::map<std::array<int, 2>, int> lines;  // curves
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    const auto& [a, b] = mesh.lines[l];
    lines[{std::min(a, b), std::max(a, b)}] = mesh.line_curve[l];
  }
  const auto sides = sorted_half_edges(mesh);
  std::vector<char> branching(mesh.curves.size(), 0);
  std::map<int, std::size_t> triangles_on;  // the first line of each curve
  std::set<int> uneven;
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    const auto at = lines.find({edge[0].lo, edge[0].hi});
    if (at == lines.end()) return;
    if (edge.size() > 2 || (edge.size() == 2 && edge[0].forward == edge[1].forward))
      branching[at->second] = 1;
    const auto [first, is_first] = triangles_on.try_emplace(at->second, edge.size());
    if (first->second != edge.size()) uneven.insert(at->second);
  });
  std::vector<std::string> wrong = check_invariants(mesh, branching);
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    const bool inside =
        edge.size() == 2 && mesh.triangle_region[edge[0].element] == mesh.triangle_region[edge[1].element];
    if (!inside && !lines.contains({edge[0].lo, edge[0].hi})) {
      wrong.push_back("no line between faces at point " + std::to_string(edge[0].lo));
    }
  });
  for (const int curve : uneven)
    wrong.push_back("curve " + std::to_string(curve) + " lies between faces and elsewhere");
  check_chains(model, wrong);
  check_faces(mesh, lines, wrong);
  return wrong;
}

/// Volume enclosed by a closed mesh of triangles.
inline double volume(const Mesh& mesh) {
  double sum = 0;
  for (const auto& v : mesh.triangles) {
    sum += dot(mesh.points[v[0]], cross(mesh.points[v[1]], mesh.points[v[2]])) / 6;
  }
  return sum;
}

/// The model is sound and has so many of each.
inline void expect_counts(const SurfaceModel& model, size_t faces, size_t curves, size_t corners) {
  EXPECT_EQ(model.fine.regions.size(), faces);
  EXPECT_EQ(model.fine.curves.size(), curves);
  EXPECT_EQ(model.corners.size(), corners);
  EXPECT_EQ(violations(model), std::vector<std::string>{});
}

}  // namespace delquad::testing_support
