// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "algorithms/fields/fields.h"
#include "algorithms/fields/surface/surface_size.h"
#include "delquad/mesh.h"
#include "delquad/metrics.h"
#include "geometry/patches/boundary_cap.h"
#include "geometry/patches/face_corners.h"
#include "geometry/patches/patch_outline.h"
#include "geometry/surface/flatten.h"
#include "geometry/surface/surface_model.h"

// This header has the patches of a surface, ready to mesh. The preparation, divisions and given meshes use
// it.

namespace delquad {

/// A patch of a surface, ready to mesh: its boundary in the parameter plane and the way back to space.
struct SurfacePatch {
  FlatPatch map;
  PatchOutline outline;
  PatchBoundary boundary;
  std::shared_ptr<const BackgroundMesh> background;  ///< the map's triangulation
  std::vector<double> tube_size;  ///< at the map's vertices, see tube_sizes(); may be empty
};

/// Quads that belong to a patch but are not within its boundary.
struct PatchCap {
  int patch;
  BoundaryCap cap;
};

struct SurfaceDomain {
  Mesh boundary;  ///< nodes on curves, lines, curves, regions (one a face); no elements
  std::vector<SurfacePatch> patches;
  std::vector<CurveChain> chains;
  std::vector<char> chain_stays;           ///< its nodes were asked for, and no stage moves them
  std::vector<int> cut_face;               ///< of each curve: the face that this cut runs through; -1: no cut
  SurfaceNodes nodes;                      ///< lines of `boundary`
  std::vector<PatchCap> caps;              ///< at tips of cones, in sharp corners
  std::vector<SharpCorner> sharp_corners;  ///< whose bound is below kBadEta
  std::vector<MappedPatch> mapped;         ///< those that become grids
  long long steps = 0;  ///< that agree_counts() and align_opposite_nodes() took, where curves were meshed
  std::vector<Warning> warnings;
};

/// Returns parameter length over length at each vertex of a map, by the areas around.
std::vector<double> stretch_of(const FlatPatch& map, const Mesh& fine);

/// delta' of a patch: delta at the point in space, or the size that a tube allows there if less, times the
/// local stretch. The stretch is parameter length / surface length, which is |det M|^(-1/4) (the paper's
/// sections 2 and 5 print +1/4). It is averaged to the map's vertices so that it is continuous.
class SurfacePatchSize final : public ParametricSize {
 public:
  SurfacePatchSize(const SurfacePatch& patch, const Mesh& fine, const SurfaceSize& size);
  double at(Vec2 u, int& hint) const override;

 private:
  const SurfacePatch& patch_;
  const Mesh& fine_;
  const SurfaceSize& size_;
  std::vector<double> stretch_;  ///< of each vertex of the map
};

/// Returns the point of the fine triangulation at u.
Vec3 fine_place(const SurfacePatch& patch, const Mesh& fine, Vec2 u, int& hint);

/// Returns the derivatives of the place by both parameters, on a triangle of a patch's map.
std::array<Vec3, 2> tangents(const SurfacePatch& patch, const Mesh& fine, int triangle);

/// Returns the outward normal of the fine triangles about u, any length. The large ones count most, since the
/// slivers of a sharp corner may be turned over.
Vec3 fine_normal(const SurfacePatch& patch, const Mesh& fine, Vec2 u, int& hint);

/// Returns the point of space at u: on the fine triangulation, then projected to the true surface where there
/// is one.
Vec3 lift(const SurfacePatch& patch, const SurfaceModel& model, Vec2 u, int& hint);

}  // namespace delquad
