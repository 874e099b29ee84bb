// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "base/budget.h"
#include "geometry/patches/curve_nodes.h"
#include "geometry/patches/patch_outline.h"

// This header looks across narrow patches. Curves use it to place nodes opposite each other.

namespace delquad {

/// Patches count as narrow up to this multiple of the size.
inline constexpr double kReach = 1.4;

/// The side that lies across a patch from a place on its boundary.
struct Opposite {
  int patch;
  int chain;  ///< curve, and place on it as in CurveNode
  double s;
  double distance;  ///< in space, straight across
};

/// Looks across patches from their boundaries, straight over the triangles of their maps.
class AcrossView {
 public:
  /// All outlive this object.
  AcrossView(const Mesh& fine, const std::vector<CurveChain>& chains, const std::vector<FlatPatch>& maps,
             const std::vector<PatchOutline>& outlines);

  /// Returns the sides seen within `reach` from a place on a curve, in each patch that it bounds there, where
  /// the two sides face each other. Corners of the boundary do not count, however the two sides near them
  /// meet, unless they are cusps.
  std::vector<Opposite> look(int chain, double s, double reach) const;

 private:
  struct Side {
    const CurveSide* curve;
    int patch, loop;
    int triangle, k;
    double path, length;  ///< along the loop before it; its own
  };

  void add_patch(int patch);
  void look_from(const Side& side, double t, double reach, std::vector<Opposite>& seen) const;
  bool faces(const Side& side, double t, Vec2 direction, const Side& other, double along,
             double distance) const;

  const Mesh& fine_;
  const std::vector<FlatPatch>& maps_;
  const std::vector<PatchOutline>& outlines_;
  std::vector<Side> sides_;
  std::vector<std::vector<std::array<int, 3>>> side_at_;   ///< of each map's triangles; -1 inside
  std::vector<std::vector<std::array<int, 2>>> sides_on_;  ///< of each curve's lines; -1: none
  std::vector<std::vector<double>> stretch_;      ///< of each map's triangles: parameter length over length
  std::vector<std::vector<double>> loop_length_;  ///< of each map's loops
};

/// Moves nodes along their curves so that nodes on both sides of a narrow place lie opposite each other, as
/// far as their numbers allow. Elsewhere edges stay of equal integrals, and between the two they change
/// gradually. Ends of curves stay. `group` is group_facing_curves(). Each look from a node takes of the
/// `steps`; once these are spent, nodes stay where they are.
CurvePlaces align_opposite_nodes(const Mesh& fine, const std::vector<CurveChain>& chains,
                                 const AcrossView& across, const std::vector<SizeIntegral>& integrals,
                                 const std::vector<int>& counts, const std::vector<int>& group,
                                 const SizeOnLine& size, Budget& steps);

}  // namespace delquad
