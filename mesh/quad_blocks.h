#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "base/counters.h"
#include "base/parallel.h"
#include "delquad/mesh.h"

namespace delquad {

/// Some elements of a quad mesh as a mesh of their own, which one thread works on. Its boundary's points are
/// some of the whole mesh's boundary, then held ones: those that other blocks have elements at, one for each
/// fan of the block's own elements. Both stay, and no edit may make an edge between a held one and a point that was there
/// before: the mesh may have that edge elsewhere.
struct QuadBlock {
  QuadPatch mesh;
  int first_held = 0;           ///< boundary points from here on are held; mesh.n_boundary: none
  std::vector<char> near;       ///< by point: 1 where there is work to do; empty: everywhere
  std::vector<int> whole = {};  ///< the point of the whole mesh, by boundary point

  /// Points that are made later are near.
  bool is_near(int v) const { return static_cast<std::size_t>(v) >= near.size() || near[v] != 0; }
};

/// A quad mesh that is worked on block by block, the same blocks for every number of threads. A mesh of less
/// than twice kBlockElements is one block. A larger one is cut along a Hilbert curve; then what lies around
/// its cuts is cut along another curve, which crosses the first cuts; what lies around the points where both
/// cross is one block at last.
class QuadBlocks {
 public:
  static constexpr int kBlockElements = 16384;

  explicit QuadBlocks(QuadPatch mesh) : mesh_(std::move(mesh)) {}

  /// The blocks of the next pass, disjoint; none when all places have been in one.
  std::vector<QuadBlock> next();
  /// Takes the blocks of this pass back, with the same boundary points.
  void put_back(std::vector<QuadBlock> blocks);
  /// The mesh: its boundary's points in their order.
  QuadPatch take() { return std::move(mesh_); }

 private:
  enum class Pass { kNone, kFirst, kAcross, kLast, kDone };
  int n_elements() const { return static_cast<int>(mesh_.quads.size() + mesh_.triangles.size()); }
  bool has_all_points() const;
  std::vector<char> grown(std::vector<char> vertices, int rings) const;
  std::vector<int> ordered_elements(const std::vector<char>& around, bool turned) const;
  void find_owners();
  std::vector<QuadBlock> cut();

  QuadPatch mesh_;
  Pass pass_ = Pass::kNone;
  std::vector<char> left_;             ///< by vertex: held in every pass so far
  std::vector<std::vector<int>> own_;  ///< the elements of each block
  std::vector<char> taken_;            ///< by element: it is in a block
  std::vector<int> owner_;             ///< by vertex: the block that has all its elements; -1: none
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
