// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "base/budget.h"
#include "geometry/patches/curve_nodes.h"
#include "geometry/patches/patch_outline.h"

// This header looks across narrow patches. Curves use it to place nodes opposite each other.

namespace delquad {

/// Largest width of a narrow patch, in sizes.
inline constexpr double kReach = 1.4;

/// The place across a patch from a place on its boundary.
struct Opposite {
  int patch;
  int chain;  ///< curve, and place on it as in CurveNode
  double s;
  double distance;  ///< in space, straight across
};

/// Looks across patches from their boundaries, straight over the triangles of their maps (own method).
class AcrossView {
 public:
  /// All arguments must outlive this object.
  AcrossView(const Mesh& fine, const std::vector<CurveChain>& chains, const std::vector<FlatPatch>& maps,
             const std::vector<PatchOutline>& outlines);

  /// Returns the places within `reach`, a length in space, across each patch beside a place on a curve
  /// (chain, s), if both sides face each other. Corners of the boundary do not count unless they are cusps.
  std::vector<Opposite> look(int chain, double s, double reach) const;

 private:
  struct Side {
    const CurveSide* curve;
    int patch, loop;
    int triangle, k;
    double path, length;  ///< length of the loop before it, and its own length
  };

  void add_patch(int patch);
  void look_from(const Side& side, double t, double reach, std::vector<Opposite>& seen) const;
  bool faces(const Side& side, double t, Vec2 direction, const Side& other, double along,
             double distance) const;

  const Mesh& fine_;
  const std::vector<FlatPatch>& maps_;
  const std::vector<PatchOutline>& outlines_;
  std::vector<Side> sides_;
  std::vector<std::vector<std::array<int, 3>>> side_at_;   ///< by map, triangle and side; -1: inside
  std::vector<std::vector<std::array<int, 2>>> sides_on_;  ///< sides on each curve's lines; -1: none
  std::vector<std::vector<double>> stretch_;      ///< parameter length over length, of each map's triangles
  std::vector<std::vector<double>> loop_length_;  ///< length of each map's loops
};

/// Returns places of nodes that lie opposite each other on both sides of narrow places, as far as their
/// numbers allow (own method). Elsewhere edges have equal integrals, with gradual changes between. Ends of
/// curves stay. `group` is from group_facing_curves(). Each look from a node costs `steps`; once these are
/// spent, nodes stay.
CurvePlaces align_opposite_nodes(const Mesh& fine, const std::vector<CurveChain>& chains,
                                 const AcrossView& across, const std::vector<SizeIntegral>& integrals,
                                 const std::vector<int>& counts, const std::vector<int>& group,
                                 const SizeOnLine& size, Budget& steps);

}  // namespace delquad
