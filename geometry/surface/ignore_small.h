// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/mesh/entity_names.h"
#include "geometry/surface/compound.h"
#include "geometry/surface/surface_model.h"
#include "geometry/surface/triangulated_model.h"

// This header removes small details of surfaces. Features and geometry use it.

namespace delquad {

struct NarrowOptions {
  double length = 0;  ///< narrower and shorter details are removed; a length
  /// A face joins only a face with all of its names that are kept; curves with such names stay.
  KeptNames keep = {};
  /// Balls in which faces and parts of faces stay.
  std::vector<FeatureBall> kept = {};
};

/// Returns the model without details smaller than `length` (own method):
/// - holes with a shorter outline are closed, see close_small_holes();
/// - parts of faces narrower than that (cusps, necks, steps that run out) are cut off, see
/// cut_narrow_parts();
/// - such a part, and a narrower face (twice its area over the length of its outline), joins a neighbor. This
///   is the neighbor with the longest common curves, where smooth joints count most. It keeps its tag and
///   names;
/// - a shorter curve joins a curve that it continues (merge_short_curves);
/// - both ends of another shorter curve become one point, if the surface keeps its topology and no point
///   moves farther than `length`. Warnings name each change with its place, the short curves that stay, and
///   lost names. SurfaceModel::before is the former triangulation. Throws InputError for a length that is not
///   below the model's diagonal.
SurfaceModel ignore_small(SurfaceModel model, const NarrowOptions& narrow,
                          const CompoundOptions& options = {});

/// Returns the model without holes whose outline is shorter than `length`, if the outline is free, or leads
/// into a tube or a pocket. A tube is a group of connected faces whose outlines are all so short. Its area is
/// at most 1.5 times its girth times its extent; it is removed. The hole is closed by triangles of the face
/// around it. A hole with several faces around it stays. Warnings name each hole.
SurfaceModel close_small_holes(SurfaceModel model, const NarrowOptions& narrow);

/// Cuts faces where they are narrower than `length` for at least twice this length and have a neighbor to
/// join. Each part becomes a face; narrow parts come last. Returns for each face its former face.
std::vector<int> cut_narrow_parts(SurfaceModel& model, const NarrowOptions& narrow);

/// Returns whether a triangle reaches into a kept ball.
bool is_kept(const Mesh& mesh, int triangle, const NarrowOptions& narrow);
/// Returns whether `host` has all kept names of `other`.
bool has_names_of(const Entity& host, const Entity& other, const KeptNames& keep);
/// Returns whether a face may join `host` across this curve.
bool may_join(const Mesh& mesh, int curve, int face, int host, const NarrowOptions& narrow);

}  // namespace delquad
