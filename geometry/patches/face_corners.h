// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <numbers>
#include <vector>

#include "delquad/metrics.h"
#include "geometry/mesh/triangle_measures.h"
#include "geometry/patches/patch_outline.h"

// This header finds corners that take one quad only. Patches use it.

namespace delquad {

/// Angle (radians) below which a corner takes one quad, with its fourth vertex inside.
inline constexpr double kOneQuadAngle = 40 * std::numbers::pi / 180;

/// A corner of a patch, between two consecutive curves of its boundary.
struct FaceCorner {
  int patch;
  int before, after;             ///< curves (chains), in the order of the patch's boundary
  bool before_ends, after_ends;  ///< whether the corner is the last point of the chain; else its first
  double angle;  ///< inside the patch, in space: the sum of its fine triangles' angles; radians
  /// Returns whether the corner is the tip of a cone: both sides are the same.
  bool is_tip() const { return before == after && before_ends == after_ends; }
};

/// Returns the corners of all patches, in the order of their boundaries.
std::vector<FaceCorner> face_corners(const Mesh& fine, const std::vector<CurveChain>& chains,
                                     const std::vector<FlatPatch>& maps,
                                     const std::vector<PatchOutline>& outlines);

/// Returns the largest possible least eta of quads that share a corner of this angle (radians) evenly.
double corner_eta_bound(double angle);

/// Returns the corners whose corner_eta_bound() is below `eta`.
std::vector<SharpCorner> find_sharp_corners(const std::vector<FaceCorner>& corners,
                                            const std::vector<CurveChain>& chains,
                                            const std::vector<FlatPatch>& maps, const SurfaceNodes& nodes,
                                            double eta);

}  // namespace delquad
