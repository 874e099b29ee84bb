#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// Named points and pairs of periodic nodes get new numbers; those of points that are gone (-1) go.
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

}  // namespace delquad
