// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <numbers>
#include <vector>

#include "delquad/metrics.h"
#include "geometry/mesh/triangle_measures.h"
#include "geometry/patches/patch_outline.h"

// This header finds corners that take one quad only. Patches use it.

namespace delquad {

/// Corners of a smaller angle than this take one quad only, with its fourth vertex inside (radians).
inline constexpr double kOneQuadAngle = 40 * std::numbers::pi / 180;

/// A corner of a patch: where one of its curves ends and the next one begins.
struct FaceCorner {
  int patch;
  int before, after;             ///< curves (chains), in the order of the patch's boundary
  bool before_ends, after_ends;  ///< whether the corner is the chain's last point, not its first
  double angle;  ///< inside the patch, in space: the sum of its fine triangles' angles; radians
  /// Returns whether the corner is the tip of a cone: both sides are the same.
  bool is_tip() const { return before == after && before_ends == after_ends; }
};

std::vector<FaceCorner> face_corners(const Mesh& fine, const std::vector<CurveChain>& chains,
                                     const std::vector<FlatPatch>& maps,
                                     const std::vector<PatchOutline>& outlines);

/// Returns the best worst eta of the quads that share a corner of this angle (radians) evenly.
double corner_eta_bound(double angle);

/// Corners whose bound is below `eta`.
std::vector<SharpCorner> find_sharp_corners(const std::vector<FaceCorner>& corners,
                                            const std::vector<CurveChain>& chains,
                                            const std::vector<FlatPatch>& maps, const SurfaceNodes& nodes,
                                            double eta);

}  // namespace delquad
