#pragma once

#include <span>
#include <vector>

#include "algorithms/layout/patch_layout.h"
#include "delquad/fields.h"
#include "delquad/mesh.h"

namespace delquad {

/// A layout as arcs, rows of edges between places where lines meet, and as pieces between these.
class LayoutArcs {
 public:
  struct Arc {
    std::vector<int> vertices;  ///< both ends included
    double length;              ///< in wanted edges
    int edges() const { return static_cast<int>(vertices.size()) - 1; }
  };
  /// An arc on the way around a piece, which gets so many quads at its beginning.
  struct Step {
    int arc;
    bool forward;
    int quads;
  };
  /// `runs`: numbers of edges into which the boundary's are divided: no arc goes over their ends.
  LayoutArcs(PatchLayout layout, const PatchBoundary& boundary, std::span<const int> runs,
             const ParametricSize& size);

  const std::vector<Arc>& arcs() const { return arcs_; }
  const std::vector<std::vector<Step>>& pieces() const { return pieces_; }
  const std::vector<std::vector<int>>& of_runs() const { return of_runs_; }  ///< in their order
  /// The same pieces with so many edges on each arc, on a boundary that has them.
  PatchLayout with(std::span<const int> edges, const PatchBoundary& boundary,
                   const ParametricSize& size) const;

 private:
  LayoutVertices vertices_;
  std::vector<Arc> arcs_;
  std::vector<std::vector<Step>> pieces_;
  std::vector<std::vector<int>> of_runs_;
};

}  // namespace delquad
