// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "delquad/mesh.h"
#include "geometry/mesh/half_edges.h"

// This header divides quads of a mesh into patches. Geometry and measures use it.

namespace delquad {

/// The quads of a mesh as patches of one region each, connected over edges inside of it. The mesh is cut open
/// along an edge unless it is in two quads of one region that run along it in opposite directions. Lines
/// within a region, such as cuts, do not matter. So one vertex of the mesh may be several nodes, each with
/// quads that follow each other. Half-edge h = 4 * quad + corner runs counterclockwise from its corner to the
/// next.
class OpenQuads {
 public:
  /// `sides` has the sorted_half_edges() of the mesh.
  OpenQuads(const Mesh& mesh, std::span<const HalfEdge> sides);

  int size() const { return static_cast<int>(out_.size()); }
  static int quad(int h) { return h >> 2; }
  static int next(int h) { return (h & 3) == 3 ? h - 3 : h + 1; }
  static int prev(int h) { return (h & 3) == 0 ? h + 3 : h - 1; }
  /// Returns the half-edge on the other side; -1: at the boundary of the patch.
  int twin(int h) const { return twin_[h]; }
  int origin(int h) const { return node_[h]; }
  int target(int h) const { return node_[next(h)]; }
  /// Returns a half-edge that leaves the node; on the patch's boundary the first one counterclockwise.
  int out(int node) const { return out_[node]; }
  /// Returns whether a node is not on the boundary of its patch.
  bool inside(int node) const { return twin_[out_[node]] >= 0; }
  /// Returns the number of quads at the node.
  int quads_at(int node) const { return quads_at_[node]; }
  /// Returns the index of a quad's patch.
  int patch(int quad) const { return patch_[quad]; }
  int n_patches() const { return n_patches_; }

  /// Calls f(h) for the half-edges that leave a node, counterclockwise, one in each quad.
  template <class F>
  void for_each_out(int node, F&& f) const {
    int h = out_[node];
    do {
      f(h);
      h = twin_[prev(h)];
    } while (h >= 0 && h != out_[node]);
  }

 private:
  void join(const Mesh& mesh, std::span<const HalfEdge> sides);
  void find_nodes();
  void find_patches();

  std::vector<int> twin_, node_;     // by half-edge
  std::vector<int> out_, quads_at_;  // by node
  std::vector<int> patch_;           // by quad
  int n_patches_ = 0;
};

}  // namespace delquad
