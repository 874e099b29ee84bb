// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "algorithms/layout/patch_layout.h"
#include "delquad/fields.h"
#include "delquad/mesh.h"

// This header has layouts as arcs and pieces. The joint choice of edges uses it.

namespace delquad {

/// A layout as arcs and pieces. An arc is a row of edges between places where lines meet.
class LayoutArcs {
 public:
  struct Arc {
    std::vector<int> vertices;  ///< both ends included
    double length;              ///< length in wanted edges
    int edges() const { return static_cast<int>(vertices.size()) - 1; }
  };
  /// An arc on the way around a piece, with the number of quads at its start.
  struct Step {
    int arc;
    bool forward;
    int quads;
  };
  /// `runs` has the numbers of edges in each run of the boundary. No arc passes the end of a run.
  LayoutArcs(PatchLayout layout, const PatchBoundary& boundary, std::span<const int> runs,
             const ParametricSize& size);

  const std::vector<Arc>& arcs() const { return arcs_; }
  const std::vector<std::vector<Step>>& pieces() const { return pieces_; }
  const std::vector<std::vector<int>>& of_runs() const { return of_runs_; }  ///< arcs of each run, in order
  /// Returns the same pieces with these numbers of edges, at least 1, on the arcs. The boundary must have the
  /// same numbers on its runs.
  PatchLayout with(std::span<const int> edges, const PatchBoundary& boundary,
                   const ParametricSize& size) const;

 private:
  LayoutVertices vertices_;
  std::vector<Arc> arcs_;
  std::vector<std::vector<Step>> pieces_;
  std::vector<std::vector<int>> of_runs_;
};

}  // namespace delquad
