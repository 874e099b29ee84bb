// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "base/counters.h"
#include "base/parallel.h"
#include "delquad/mesh.h"
#include "geometry/mesh/element_blocks.h"

// This header divides quad meshes into blocks that threads edit. Geometry, stages and smoothing use it.

namespace delquad {

/// Some elements of a quad mesh as a mesh of their own, which one thread works on. Its boundary has points of
/// the whole mesh's boundary, then held points. Other blocks have elements at a held point, and the block has
/// one for each fan of its own elements. Both stay. No edit may make an edge between a held one and a point
/// that was there before: the mesh may have that edge elsewhere.
struct QuadBlock {
  QuadPatch mesh;
  int first_held = 0;           ///< boundary points from here on are held; mesh.n_boundary: none
  std::vector<char> near;       ///< by point: 1 where there is work to do; empty: everywhere
  std::vector<int> whole = {};  ///< the point of the whole mesh, by boundary point

  /// Returns whether a point is near a cut. Points that are made later are near.
  bool is_near(int v) const { return static_cast<std::size_t>(v) >= near.size() || near[v] != 0; }
};

/// A quad mesh that is worked on block by block, see ElementBlocks.
class QuadBlocks {
 public:
  explicit QuadBlocks(QuadPatch mesh) : mesh_(std::move(mesh)) {}

  /// Returns the blocks of the next pass, disjoint; none when all places have been in one. A mesh with
  /// corners that are no points is one block, for others to refuse.
  std::vector<QuadBlock> next();
  /// Takes the blocks of this pass back, with the same boundary points.
  void put_back(std::vector<QuadBlock> blocks);
  /// Returns the mesh: its boundary's points in their order.
  QuadPatch take() { return std::move(mesh_); }

 private:
  bool has_all_points() const;

  QuadPatch mesh_;
  ElementBlocks blocks_;
  bool begun_ = false, refused_ = false;
};

/// Replaces each block's mesh by what work(block, summary) returns, pass after pass, and adds up what the
/// calls say. They run in parallel.
template <class Summary, class Work>
QuadPatch work_in_blocks(QuadPatch mesh, Summary& total, const Work& work) {
  QuadBlocks whole(std::move(mesh));
  for (std::vector<QuadBlock> blocks = whole.next(); !blocks.empty(); blocks = whole.next()) {
    std::vector<Summary> summaries(blocks.size());
    parallel_for(blocks.size(), [&](std::size_t i) { blocks[i].mesh = work(blocks[i], summaries[i]); });
    for (const Summary& summary : summaries) add_counters(total, summary);
    whole.put_back(std::move(blocks));
  }
  return whole.take();
}

}  // namespace delquad
