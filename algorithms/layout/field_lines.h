// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "algorithms/layout/patch_layout.h"
#include "base/box_tree.h"
#include "delquad/fields.h"
#include "delquad/mesh.h"

// This header traces lines of the cross field between rims. Layouts use them as cuts.

namespace delquad {

/// A place on one of several rims: indices of the rim and of its vertex.
struct RimPlace {
  int rim, at;
  friend bool operator==(const RimPlace&, const RimPlace&) = default;
};

/// A line along the cross field between two vertices of rims, in the parameter plane.
struct FieldLine {
  RimPlace from, to;
  int along;  ///< quads at its start between the line and the next edge of the rim
  int back;   ///< quads at its end between the line and the previous edge of the rim
  std::vector<Vec2> path;
  std::vector<double> edges;  ///< length in wanted edges, up to each point of the path
  double misfit;  ///< cost >= 0: sum of squared deviations of its ends from place and direction of the field
};

/// Tracer of lines of a cross field in a piece of a patch (own method).
class FieldLines {
 public:
  /// All arguments but `rims` must outlive this object.
  FieldLines(const CrossField& cross, const ParametricSize& size, const LayoutVertices& vertices,
             std::span<const Rim> rims);

  /// Adds the lines from a place: one between each two adjacent quads there, to either end of the edge that
  /// it meets.
  void trace(RimPlace from, std::vector<FieldLine>& lines);
  /// Returns whether a row of vertices between two places meets no rim on its way.
  bool is_free(RimPlace from, RimPlace to, std::span<const Vec2> row) const;

 private:
  struct Edge {
    RimPlace from, to;
  };
  /// Angle at a place between its outgoing and its incoming edge.
  struct Corner {
    Vec2 out;
    double angle;
  };
  const RimVertex& entry(RimPlace p) const { return rims_[p.rim][p.at]; }
  Vec2 place(RimPlace p) const { return vertices_.places[entry(p).vertex]; }
  RimPlace next(RimPlace p) const { return {p.rim, (p.at + 1) % static_cast<int>(rims_[p.rim].size())}; }
  RimPlace before(RimPlace p) const {
    const int n = static_cast<int>(rims_[p.rim].size());
    return {p.rim, (p.at + n - 1) % n};
  }
  Corner corner(RimPlace p) const;
  Vec2 arm(Vec2 at, Vec2 direction);
  void trace(RimPlace from, int along, std::vector<FieldLine>& lines);
  void end(FieldLine line, Vec2 hit, RimPlace to, std::vector<FieldLine>& lines) const;

  const CrossField& cross_;
  const ParametricSize& size_;
  const LayoutVertices& vertices_;
  std::vector<Rim> rims_;
  std::vector<Edge> edges_;
  BoxTree<Vec2> tree_;
  int cross_hint_ = -1, size_hint_ = -1;
};

}  // namespace delquad
