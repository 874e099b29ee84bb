// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <vector>

#include "delquad/mesh.h"
#include "geometry/mesh/cell_shapes.h"

// This header removes points that no element uses. The pipeline, features, readers and writers and geometry
// use it.

namespace delquad {

/// Gives named points and pairs of periodic nodes the numbers in `renamed`, and drops them if a number is -1.
inline void renumber_nodes(Mesh& mesh, const std::vector<int>& renamed) {
  std::erase_if(mesh.named_points, [&](const NamedPoint& named) { return renamed[named.point] < 0; });
  for (NamedPoint& named : mesh.named_points) named.point = renamed[named.point];
  const auto renumber = [&](auto& pairs) {
    for (auto& pair : pairs) {
      std::erase_if(pair.nodes,
                    [&](const auto& nodes) { return renamed[nodes[0]] < 0 || renamed[nodes[1]] < 0; });
      for (auto& nodes : pair.nodes)
        for (int& v : nodes) v = renamed[v];
    }
  };
  renumber(mesh.periodic);
  renumber(mesh.periodic_faces);
}

/// Removes the points that no element uses, and their names; the others keep their order. Returns the new
/// number of each point; -1: removed.
inline std::vector<int> drop_unused_points(Mesh& mesh) {
  std::vector<int> index(mesh.points.size(), -1);
  const auto each_vertex = [&](auto&& visit) {
    for (auto& e : mesh.lines) std::for_each(e.begin(), e.end(), visit);
    for (auto& e : mesh.triangles) std::for_each(e.begin(), e.end(), visit);
    for (auto& e : mesh.quads) std::for_each(e.begin(), e.end(), visit);
    for_each_shape(mesh, [&](const SolidShape&, auto& cells, const auto&) {
      for (auto& e : cells) std::for_each(e.begin(), e.end(), visit);
    });
    for (auto* nodes : {&mesh.line_nodes, &mesh.quad_nodes})
      std::for_each(nodes->begin(), nodes->end(), visit);
  };
  each_vertex([&](int v) { index[v] = 0; });
  int kept = 0;
  for (size_t i = 0; i < index.size(); ++i) {
    if (index[i] < 0) continue;
    mesh.points[kept] = mesh.points[i];
    index[i] = kept++;
  }
  mesh.points.resize(kept);
  renumber_nodes(mesh, index);
  each_vertex([&](int& v) { v = index[v]; });
  return index;
}

}  // namespace delquad
