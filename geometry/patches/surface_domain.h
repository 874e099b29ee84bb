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
  std::vector<double> tube_size;  ///< largest sizes at the map's vertices, see tube_sizes(); empty: no limit
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
  std::vector<char> chain_stays;           ///< whether its nodes were requested, so that no stage moves them
  std::vector<int> cut_face;               ///< face of each curve that is a cut; -1: no cut
  SurfaceNodes nodes;                      ///< nodes on the chains
  std::vector<PatchCap> caps;              ///< caps at tips of cones and in sharp corners
  std::vector<SharpCorner> sharp_corners;  ///< corners whose eta bound is below kBadEta
  std::vector<MappedPatch> mapped;         ///< patches that become grids
  long long steps = 0;                     ///< steps of agree_counts() and align_opposite_nodes()
  std::vector<Warning> warnings;
};

/// Returns parameter length over length in space at each vertex of a map, by the areas around.
std::vector<double> stretch_of(const FlatPatch& map, const Mesh& fine);

/// delta' of a patch: delta at the point in space, or the size that a tube allows there if less, times the
/// local stretch. The stretch is parameter length / surface length, which is |det M|^(-1/4) [remacle2013,
/// sections 2 and 5, which print +1/4]. It is averaged to the map's vertices so that it is continuous.
class SurfacePatchSize final : public ParametricSize {
 public:
  SurfacePatchSize(const SurfacePatch& patch, const Mesh& fine, const SurfaceSize& size);
  double at(Vec2 u, int& hint) const override;

 private:
  const SurfacePatch& patch_;
  const Mesh& fine_;
  const SurfaceSize& size_;
  std::vector<double> stretch_;  ///< stretch at each vertex of the map
};

/// Returns the point of the fine triangulation at u.
Vec3 fine_place(const SurfacePatch& patch, const Mesh& fine, Vec2 u, int& hint);

/// Returns the derivatives of the place in space by both parameters, on a triangle of a patch's map.
std::array<Vec3, 2> tangents(const SurfacePatch& patch, const Mesh& fine, int triangle);

/// Returns the outward normal of the fine triangles about u, of any length. Large triangles count most, since
/// slivers in a sharp corner may be reversed.
Vec3 fine_normal(const SurfacePatch& patch, const Mesh& fine, Vec2 u, int& hint);

/// Returns the point of space at u: on the fine triangulation, then projected to the true surface if there is
/// one.
Vec3 lift(const SurfacePatch& patch, const SurfaceModel& model, Vec2 u, int& hint);

}  // namespace delquad
