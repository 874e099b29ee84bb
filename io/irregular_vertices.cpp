#include "io/irregular_vertices.h"

#include "geometry/mesh/half_edges.h"
#include "metrics/regularity.h"

namespace delquad {

IrregularVertices irregular_vertices(const Mesh& mesh, int regular, const std::vector<double>& element_size) {
  std::vector<int> valence(mesh.points.size(), 0);
  std::vector<double> size(mesh.points.size(), 0);
  for_each_element(mesh, [&](int element, const auto& v) {
    for (const int i : v) {
      ++valence[i];
      size[i] += element_size[element];
    }
  });
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  std::vector<int> shown = valence;
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    if (edge.size() != 2) shown[edge[0].lo] = shown[edge[0].hi] = regular;
  });
  IrregularVertices irregular;
  if (mesh.triangles.empty())
    for (const IrregularPair& pair : pair_irregular(mesh, sides).pairs) {
      irregular.pairs.push_back({pair.few, pair.many});
      if (shown[pair.few] == regular) shown[pair.few] = regular - 1;
      if (shown[pair.many] == regular) shown[pair.many] = regular + 1;
    }
  for (int i = 0; i < static_cast<int>(valence.size()); ++i)
    if (shown[i] != regular && valence[i] != 0)
      irregular.vertices.push_back({i, shown[i], size[i] / valence[i]});
  return irregular;
}

}  // namespace delquad
