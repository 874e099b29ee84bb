#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/matching/matching.h"
#include "delquad/mesh.h"
#include "fields/fields.h"
#include "fields/surface/surface_size.h"
#include "geometry/surface/flatten.h"
#include "geometry/surface/periodic_faces.h"
#include "geometry/surface/surface_model.h"
#include "patches/boundary_cap.h"
#include "patches/face_corners.h"
#include "patches/patch_outline.h"

namespace delquad {

/// A quad below this eta, with an angle below 10 or above 170 degrees, is bad.
inline constexpr double kBadEta = 1.0 / 9;

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
  SurfaceNodes nodes;                      ///< those of `boundary`
  std::vector<PatchCap> caps;              ///< at tips of cones, in sharp corners
  std::vector<SharpCorner> sharp_corners;  ///< whose bound is below kBadEta
  std::vector<MappedPatch> mapped;         ///< those that become grids
  long long steps = 0;  ///< that agree_counts() and face_nodes() took, where curves were meshed
  std::vector<Warning> warnings;
};

/// Meshes the curves of a flattened model once each and gives every patch its boundary. All patches are even
/// wherever that is possible at all; where a boundary polygon would cross itself in the parameter plane, the
/// curves of that patch are refined. Warnings name the curves shorter than the size and the patches left odd;
/// `asked` is the size that these refer to (null: `size` itself, which may be less beside such curves).
/// Curves of `divisions` get these edges, and the second sides of `periodic` the images of the nodes of the
/// first: faces that are images have no patches, see `boundary.periodic_faces`. Patches that become grids, as
/// `mapped` asks, get numbers that fit. `agreement`: the price of agree_on_counts(); 0: numbers follow the
/// size alone. Throws FaceError when no refinement gives a valid boundary, naming the face, and InputError
/// where divisions leave a patch with an odd number of edges.
SurfaceDomain make_surface_domain(const SurfaceModel& model, Flattening flattening, const SurfaceSize& size,
                                  const MatchingSolver& solver, const SizeField* asked = nullptr,
                                  const std::vector<CurveDivision>& divisions = {},
                                  const PeriodicSides& periodic = {}, const MappedSpec& mapped = {},
                                  double agreement = 0);

/// The same of a model whose curves are kept point by point: all their points are nodes, and no stage moves
/// those that are on no cut. The k-th point of a patch's boundary is the vertex of its map from which the
/// k-th side of its outline begins. Warnings name the patches with an odd boundary.
SurfaceDomain make_kept_domain(const SurfaceModel& model, Flattening flattening, const SurfaceSize& size);

/// delta' of a patch: delta at the point in space, or what a tube allows there if less, times the local
/// stretch parameter length / surface length, which is |det M|^(-1/4) (the paper's sections 2 and 5 print
/// +1/4), averaged to the map's vertices so that it is continuous.
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

/// The point of the fine triangulation at u.
Vec3 fine_place(const SurfacePatch& patch, const Mesh& fine, Vec2 u, int& hint);

/// Outward normal of the fine triangles about u, any length: the large ones count most, since the slivers of
/// a sharp corner may be turned over.
Vec3 fine_normal(const SurfacePatch& patch, const Mesh& fine, Vec2 u, int& hint);

/// The point of space at u: on the fine triangulation, then projected to the true surface where there is one.
Vec3 lift(const SurfacePatch& patch, const SurfaceModel& model, Vec2 u, int& hint);

}  // namespace delquad
