#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// Quads that are cut off a patch at a corner of its boundary, where insertion has no choice.
struct BoundaryCap {
  int tip;                                ///< node of the corner
  int points;                             ///< of the boundary that stand in its place
  std::vector<std::array<int, 4>> quads;  ///< nodes of the boundary mesh, oriented as the patch
  std::vector<int> within;   ///< nodes that are no longer on the patch's boundary, besides the tip
  std::vector<int> dropped;  ///< nodes of curves that are no longer there at all
};

/// A boundary as loops of its points, from each an edge to the next.
struct LoopPoint {
  Vec2 point;
  int node, curve;  ///< of the edge that begins here
};
using BoundaryLoop = std::vector<LoopPoint>;
std::vector<BoundaryLoop> take_loops(const PatchBoundary& boundary);
PatchBoundary make_boundary(const std::vector<BoundaryLoop>& loops);
/// Puts other points in the place of the tip and of those fewer than k beside it.
void cut_off_tip(BoundaryLoop& loop, std::size_t tip, std::size_t k, std::span<const LoopPoint> fresh);
/// Caps what make(loops, loop, point) caps, which changes the loop.
template <class Make>
std::vector<BoundaryCap> cap_loops(PatchBoundary& boundary, Make make) {
  std::vector<BoundaryCap> caps;
  std::vector<BoundaryLoop> loops = take_loops(boundary);
  for (std::size_t l = 0; l < loops.size(); ++l)
    for (std::size_t i = 0; i < loops[l].size(); ++i)
      if (std::optional<BoundaryCap> cap = make(loops, l, i)) {
        caps.push_back(std::move(*cap));
        i = static_cast<std::size_t>(-1);  // the loop has changed
      }
  if (!caps.empty()) boundary = make_boundary(loops);
  return caps;
}

}  // namespace delquad
