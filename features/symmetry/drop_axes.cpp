#include <algorithm>

#include "features/symmetry/planar_symmetry.h"
#include "geometry/mesh/keep_elements.h"

namespace delquad {
namespace {

void drop_unused_nodes(ModelChain& chain, std::vector<CurvePiece>& pieces) {
  std::vector<int> renamed(chain.nodes.size(), -1);
  for (const CurvePiece& piece : pieces)
    for (const int v : piece.ends) renamed[v] = 0;
  for (const int v : chain.point_nodes) renamed[v] = 0;
  std::vector<Vec2> nodes;
  for (std::size_t v = 0; v < renamed.size(); ++v)
    if (renamed[v] == 0) {
      renamed[v] = static_cast<int>(nodes.size());
      nodes.push_back(chain.nodes[v]);
    }
  chain.nodes = std::move(nodes);
  for (CurvePiece& piece : pieces)
    for (int& v : piece.ends) v = renamed[v];
  for (int& v : chain.point_nodes) v = renamed[v];
}

}  // namespace

void drop_axes_outside(const Mesh& lines, int first_axis, ModelChain& chain,
                       std::vector<CurvePiece>& pieces) {
  std::vector<Vec2> points;
  for (const Vec3& x : lines.points) points.push_back({x.x, x.y});
  const Arrangement arrangement = arrange(points, lines.lines);
  if (arrangement.conflict) return;
  std::vector<CurvePiece> kept;
  std::size_t side = 0;
  for (CurvePiece& piece : pieces) {
    const bool is_outside = arrangement.face_of[side] < 0 && arrangement.face_of[side + 1] < 0;
    side += 2 * static_cast<std::size_t>(piece.n);
    if (!is_outside || std::ranges::any_of(piece.curves, [&](int c) { return c < first_axis; }))
      kept.push_back(std::move(piece));
  }
  pieces = std::move(kept);
  drop_unused_nodes(chain, pieces);
}

void drop_axes(int first_axis, PlanarDomain& domain) {
  std::vector<char> dropped(domain.boundary.curves.size(), 0);
  for (std::size_t c = 0; c < domain.model_curves.size(); ++c) {
    auto& curves = domain.model_curves[c];
    const bool had = !curves.empty();
    std::erase_if(curves, [&](int m) { return m >= first_axis; });
    dropped[c] = had && curves.empty();
  }
  Mesh& mesh = domain.boundary;
  keep_lines(mesh, [&](std::size_t l) { return !dropped[mesh.line_curve[l]]; });
  for (PatchBoundary& patch : domain.patches)
    for (int& curve : patch.edge_curve)
      if (curve >= 0 && dropped[curve]) curve = -1;
}

}  // namespace delquad
