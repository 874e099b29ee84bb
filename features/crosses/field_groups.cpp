#include "features/crosses/field_groups.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include "base/disjoint_sets.h"
#include "features/sizes/curve_options.h"
#include "geometry/surface/compound.h"

namespace delquad {
namespace {

/// Of each curve, how much fields are drawn to it; none where fields are given there.
std::vector<std::optional<double>> alignments(const PreparedProblem& prepared) {
  std::vector<std::optional<double>> of_curve(prepared.boundary.curves.size());
  if (!prepared.surface) return of_curve;
  const CurveOptions options = curve_options(prepared.settings.options);
  const std::vector<char> smooth = tangent_curves(prepared.surface->model);
  for (std::size_t c = 0; c < of_curve.size() && c < smooth.size(); ++c)
    if (smooth[c]) of_curve[c] = options.alignment;
  for (const SurfaceCut& cut : prepared.surface->cuts) of_curve[cut.curve] = options.cut_alignment;
  return of_curve;
}

struct SharedEdge {
  std::vector<FieldSeam::Side> sides;
  std::vector<int> from;  ///< the node at which each begins
};

/// Edges of curves where fields are not given, by curve and nodes.
std::map<std::array<int, 3>, SharedEdge> shared_edges(
    const PreparedProblem& prepared, const std::vector<std::shared_ptr<const BackgroundMesh>>& backgrounds,
    const std::vector<std::optional<double>>& alignment) {
  std::map<std::array<int, 3>, SharedEdge> shared;
  for (int i = 0; i < static_cast<int>(backgrounds.size()); ++i) {
    const PatchBoundary& boundary = prepared.patches[i].boundary;
    std::vector<int> curve_from(boundary.points.size(), -1);
    for (std::size_t e = 0; e < boundary.edges.size(); ++e)
      curve_from[boundary.edges[e][0]] = boundary.edge_curve[e];
    const TriPatch& tri = backgrounds[i]->triangles();
    for (int t = 0; t < static_cast<int>(tri.triangles.size()); ++t)
      for (int k = 0; k < 3; ++k) {
        if (tri.neighbours[t][k] >= 0) continue;
        const int from = tri.triangles[t][(k + 1) % 3], to = tri.triangles[t][(k + 2) % 3];
        const int curve = curve_from[from];
        if (curve < 0 || !alignment[curve]) continue;
        const auto [low, high] = std::minmax(boundary.point_node[from], boundary.point_node[to]);
        SharedEdge& edge = shared[{curve, low, high}];
        edge.sides.push_back({i, t, k});
        edge.from.push_back(boundary.point_node[from]);
      }
  }
  return shared;
}

}  // namespace

std::vector<FieldGroup> field_groups(const PreparedProblem& prepared,
                                     const std::vector<std::shared_ptr<const BackgroundMesh>>& backgrounds) {
  const std::vector<std::optional<double>> alignment = alignments(prepared);
  std::vector<FieldSeam> seams;
  DisjointSets joined(backgrounds.size());
  for (const auto& [key, edge] : shared_edges(prepared, backgrounds, alignment)) {
    if (edge.sides.size() != 2 || edge.from[0] == edge.from[1]) continue;
    seams.push_back({{edge.sides[0], edge.sides[1]}, *alignment[key[0]]});
    joined.join(edge.sides[0].patch, edge.sides[1].patch);
  }

  std::vector<FieldGroup> groups;
  std::vector<int> group_of(joined.size()), place(joined.size());
  for (int i = 0; i < std::ssize(group_of); ++i) {
    const int root = joined.root(i);
    if (root == i) groups.emplace_back();
    group_of[i] = root == i ? static_cast<int>(groups.size()) - 1 : group_of[root];
    FieldGroup& group = groups[group_of[i]];
    place[i] = static_cast<int>(group.patches.size());
    group.patches.push_back(i);
  }
  for (FieldSeam& seam : seams) {
    FieldGroup& group = groups[group_of[seam.sides[0].patch]];
    for (FieldSeam::Side& side : seam.sides) side.patch = place[side.patch];
    group.seams.push_back(seam);
  }
  return groups;
}

}  // namespace delquad
