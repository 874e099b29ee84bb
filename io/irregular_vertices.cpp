#include "io/irregular_vertices.h"

#include "mesh/half_edges.h"

namespace delquad {

std::vector<IrregularVertex> irregular_vertices(const Mesh& mesh, int regular,
                                                const std::vector<double>& element_size) {
  std::vector<int> valence(mesh.points.size(), 0);
  std::vector<double> size(mesh.points.size(), 0);
  for_each_element(mesh, [&](int element, const auto& v) {
    for (const int i : v) {
      ++valence[i];
      size[i] += element_size[element];
    }
  });
  for_each_edge(sorted_half_edges(mesh), [&](std::span<const HalfEdge> edge) {
    if (edge.size() != 2) valence[edge[0].lo] = valence[edge[0].hi] = regular;
  });
  std::vector<IrregularVertex> irregular;
  for (int i = 0; i < static_cast<int>(valence.size()); ++i) {
    if (valence[i] != regular && valence[i] != 0) irregular.push_back({i, valence[i], size[i] / valence[i]});
  }
  return irregular;
}

}  // namespace delquad
