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
  double length = 0;  ///< what is narrower goes
  /// A face becomes only part of one with all of its names that are kept, and curves with such names stay.
  KeptNames keep = {};
  /// Faces and parts of faces that reach into these stay.
  std::vector<FeatureBall> kept = {};
};

/// Returns the model without what is smaller than `length`:
/// - holes of a shorter outline are closed, see close_small_holes();
/// - parts of faces narrower than that (cusps, necks, steps that run out) are cut off, see
/// cut_narrow_parts();
/// - such a part, and a face narrower than that (twice its area by the length of its outline), becomes part
///   of a neighbor. This is the neighbor with which it shares the longest curves, smooth joints counting
///   most. It keeps its tag and names;
/// - a shorter curve becomes one with a curve that it continues (merge_short_curves);
/// - of other shorter curves, both ends become one point, if the surface keeps its topology by that, and no
///   point moves farther than `length`. Warnings name each of these with its place, the short curves that
///   stay, and names that no face and no curve has any more. `before` is the former model. Throws InputError
///   for a length that is not below the model's diagonal.
SurfaceModel ignore_small(SurfaceModel model, const NarrowOptions& narrow,
                          const CompoundOptions& options = {});

/// Returns the model without holes whose outline is shorter than `length`, if the outline bounds nothing
/// else, or leads into a tube or a pocket. A tube is a group of connected faces whose outlines are all so
/// short. Its area is not much more than the area of a tube of such a girth and extent; it is removed. The
/// hole is closed by triangles of the face around it. A hole with several faces around it stays. Warnings
/// name each hole.
SurfaceModel close_small_holes(SurfaceModel model, const NarrowOptions& narrow);

/// Cuts faces at places where they are narrower than that for a while and have a neighbor to join. The narrow
/// parts become faces of their own. So do all other parts but the largest, behind the others. Returns for
/// each face the one that it was a part of.
std::vector<int> cut_narrow_parts(SurfaceModel& model, const NarrowOptions& narrow);

/// Returns whether a triangle reaches into what is kept.
bool is_kept(const Mesh& mesh, int triangle, const NarrowOptions& narrow);
/// Returns whether it has all names of the other that are kept.
bool has_names_of(const Entity& host, const Entity& other, const KeptNames& keep);
/// Returns whether a face may become part of another one across this curve.
bool may_join(const Mesh& mesh, int curve, int face, int host, const NarrowOptions& narrow);

}  // namespace delquad
