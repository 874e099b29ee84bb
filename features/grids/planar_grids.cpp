#include <algorithm>
#include <numeric>

#include "features/grids/grids.h"

namespace delquad {
namespace {

/// Where on a patch's outline parts with these numbers of edges begin, the first of them at `nodes`; -1: it
/// is another patch.
int outline_begin(const std::vector<Vec2>& nodes, const std::vector<int>& counts, const PatchBoundary& patch,
                  const std::vector<Vec3>& points) {
  const int n = std::accumulate(counts.begin(), counts.end(), 0);
  // Points moved apart along a cut are told by the nodes that they stand for.
  const auto is_at = [&](int i, Vec2 x) {
    const Vec3& node = points[patch.point_node[i % n]];
    return node.x == x.x && node.y == x.y;
  };
  for (int first = 0; first < n; ++first) {
    int at = first;
    bool fits = true;
    for (std::size_t k = 0; fits && k < counts.size(); at += counts[k++]) fits = is_at(at, nodes[k]);
    if (fits) return first;
  }
  return -1;
}

/// Where the parts of its outline begin, loop by loop.
std::vector<Vec2> nodes_of(const MappedFace& face, const Mesh& fine, const SurfaceCurves& curves) {
  std::vector<Vec2> nodes;
  for (const auto& loop : curves.outlines[face.face])
    for (const CurveSide& side : loop) {
      const CurveChain& chain = curves.chains[side.chain];
      if (!side.begins(chain)) continue;
      const Vec3& x = fine.points[side.forward ? chain.points.front() : chain.points.back()];
      nodes.push_back({x.x, x.y});
    }
  return nodes;
}

}  // namespace

std::vector<MappedPatch> mapped_patches(const std::vector<MappedFace>& mapped, const Mesh& fine,
                                        const SurfaceCurves& curves, const std::vector<CurvePiece>& pieces,
                                        const std::vector<PatchBoundary>& patches,
                                        const std::vector<Vec3>& points) {
  std::vector<MappedPatch> found;
  for (const MappedFace& face : mapped) {
    std::vector<int> counts;  // of the parts of its outline, from that on at which the first side begins
    for (const auto& side : face.sides)
      for (const int piece : side) counts.push_back(pieces[piece].n);
    const int n_edges = std::accumulate(counts.begin(), counts.end(), 0);
    std::vector<Vec2> nodes = nodes_of(face, fine, curves);
    if (face.begins.empty())
      counts.resize(face.sides[0].size());
    else
      std::ranges::rotate(nodes, nodes.begin() + static_cast<long>(face.begins[0]));
    for (std::size_t p = 0; p < patches.size(); ++p) {
      const int n = static_cast<int>(patches[p].points.size());
      if (n != n_edges) continue;
      const int first = outline_begin(nodes, counts, patches[p], points);
      if (first < 0) continue;
      MappedPatch& patch = found.emplace_back(MappedPatch{static_cast<int>(p), {}, face.is_asked, face.rows});
      int at = first;
      for (const auto& side : face.sides) {
        if (face.begins.empty()) break;
        patch.corners.push_back(at % n);
        for (const int piece : side) at += pieces[piece].n;
      }
      break;
    }
  }
  return found;
}

}  // namespace delquad
