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

/// Some elements of a quad mesh as an own mesh, which one thread edits. Its boundary has points of the whole
/// mesh's boundary, then held points; both stay. Other blocks have elements at a held point, and each fan of
/// own elements has its own. No edit may join a held point and an old point, since the whole mesh may have
/// this edge elsewhere.
struct QuadBlock {
  QuadPatch mesh;
  int first_held = 0;           ///< boundary points from here on are held; mesh.n_boundary: none
  std::vector<char> near;       ///< by point: 1 if there is work to do; empty: everywhere
  std::vector<int> whole = {};  ///< point of the whole mesh for each boundary point

  /// Returns whether there is work to do at a point, as at all new points.
  bool is_near(int v) const { return static_cast<std::size_t>(v) >= near.size() || near[v] != 0; }
};

/// A quad mesh that is edited block by block, see ElementBlocks.
class QuadBlocks {
 public:
  explicit QuadBlocks(QuadPatch mesh) : mesh_(std::move(mesh)) {}

  /// Returns the disjoint blocks of the next pass; none if all places have been in one. A mesh with corners
  /// that are no points is one block, which QuadTopology refuses.
  std::vector<QuadBlock> next();
  /// Takes the blocks of this pass back, with the same boundary points.
  void put_back(std::vector<QuadBlock> blocks);
  /// Returns the mesh, with the boundary's points in their order.
  QuadPatch take() { return std::move(mesh_); }

 private:
  bool has_all_points() const;

  QuadPatch mesh_;
  ElementBlocks blocks_;
  bool begun_ = false, refused_ = false;
};

/// Returns the mesh after each block's mesh was replaced by the result of work(block, summary), pass after
/// pass. Calls run in parallel; `total` gets the sum of their summaries.
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
