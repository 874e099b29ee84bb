// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/matching/edge_counts.h"
#include "delquad/model.h"
#include "geometry/patches/meshing_setup.h"
#include "geometry/patches/surface_curves.h"
#include "geometry/planar/curve_pieces.h"
#include "geometry/planar/planar_model.h"

// This header finds faces that become grids, and gives their curves fitting numbers of edges. The pipeline
// and features use it.

namespace delquad {

/// A part of the outline of a face between two nodes that any mesh has, with the face on its left.
struct OutlinePart {
  int curve;     ///< piece of a curve, whose number of edges is chosen
  int node;      ///< node at its beginning
  Vec3 at;       ///< place of that node
  double angle;  ///< inside of the face at that node; radians
  double ideal;  ///< number of edges by size
};
using FaceOutline = std::vector<std::vector<OutlinePart>>;  ///< loops, the outer one first

/// A face that becomes a grid of four sides, three grids that meet inside (three sides), or a ring.
struct MappedFace {
  int face;
  bool is_requested;                    ///< by name, not found automatically
  std::vector<std::vector<int>> sides;  ///< curves of each side, in order; of a ring its loops
  std::vector<std::size_t>
      begins;    ///< places in the outline at which sides begin, ascending; of a ring: none
  int rows = 0;  ///< see MappedSpec::rings; 0: by size
};

/// Finds the faces that become grids, and their corners. Given points are corners. Otherwise a face with
/// exactly three nodes, or exactly three that turn by more than 30 degrees, has these. Any other face has the
/// four nodes at which it turns most like a rectangle. Two loops without such turns are a ring.
///
/// Faces found by `automatic` have four corners within 35 degrees of right angles, and other nodes within 30
/// degrees of straight. The wanted numbers of edges of opposite sides differ at most by a factor of two, or
/// by one. The same limits hold for narrow faces that become grids without a request. They are strips, at
/// most 2.5 sizes wide and longer than that, and rings of that width. Own method.
class GridFinder {
 public:
  using NamedPlaces = std::vector<std::pair<std::string, Vec3>>;
  /// Throws InputError for names that no region has. The arguments must outlive this object.
  GridFinder(const MappedSpec& spec, const std::vector<Entity>& regions, const NamedPlaces& points);

  /// Returns the grid of a face; nothing if the face stays free. `quads` is the number of quads by its area.
  /// Throws InputError if a named face cannot be a grid.
  std::optional<MappedFace> find(int face, const Entity& region, const FaceOutline& outline, double quads);
  /// Throws InputError for corners that lie on no outline. Call it after all faces.
  void finish() const;

 private:
  struct Corners {
    const GridCorners* asked;
    std::vector<Vec3> at;
    bool is_used = false;
    std::string missing;  ///< why they are not nodes of an outline
  };
  std::vector<std::size_t> requested_corners(const Entity& region, const FaceOutline& outline);

  const MappedSpec& spec_;
  std::vector<Corners> corners_;
};

/// Chooses numbers of edges, see balance_counts(), and returns the faces without a solution. `around` has the
/// curves of each face, one entry for each side. `leader` has, for each curve, the curve whose number it
/// shares. Faces without a request become free if the others cannot agree with them.
std::vector<UnbalancedFace> balance_grids(std::vector<CountedCurve>& curves,
                                          const std::vector<std::vector<int>>& around,
                                          const std::vector<int>& leader, std::vector<MappedFace>& mapped);

/// Returns why a face cannot be balanced. `mapped` is null for a free face. `curves` have their numbers of
/// edges, and `names` their names.
std::string why_unbalanced(const UnbalancedFace& bad, const std::string& label, const MappedFace* mapped,
                           const std::vector<CountedCurve>& curves, const std::vector<std::string>& names);

/// Returns the patches (MappedFace::face) that become grids of their faces, see GridFinder. A face that was
/// cut open into one patch may be a tube, with the cut on two opposite sides. Throws InputError as
/// GridFinder, and for a named face of several patches.
std::vector<MappedFace> find_surface_grids(const MappedSpec& spec, const Mesh& fine,
                                           const SurfaceCurves& curves, const CurveDemands& wanted);

/// Returns numbers of edges of chains, so that mapped patches fit and all others have an even boundary.
/// `odd_patches` gets the patches without a solution. Patches without a request may drop out of `mapped`.
/// Throws InputError if a named face cannot be a grid.
std::vector<int> grid_counts(const MappedSpec& spec, const Mesh& fine, const SurfaceCurves& curves,
                             const CurveDemands& wanted, std::vector<MappedFace>& mapped,
                             std::vector<int>& odd_patches);

/// Returns whether opposite sides, or the loops of a ring, have equal numbers of edges.
bool is_balanced(const MappedFace& face, const std::vector<int>& counts);

/// Returns the grids by the places on patch boundaries at which their sides begin.
std::vector<MappedPatch> grid_patches(const std::vector<MappedFace>& mapped, const SurfaceCurves& curves,
                                      const std::vector<int>& counts);

/// Returns the same for a planar domain whose curves were meshed. Chain i of `curves` is piece i.
std::vector<MappedPatch> mapped_patches(const std::vector<MappedFace>& mapped, const SurfaceCurves& curves,
                                        const std::vector<CurvePiece>& pieces, const Arrangement& arrangement,
                                        const FaceRegions& regions);

/// Fills patches with their grids. In the plane, and in the parameter plane of a surface, nodes come from
/// transfinite interpolation. On a surface they also come from interpolation in space, each at the nearest
/// point of the patch. The grid whose quads are better in space on average is taken. A grid that would fold
/// is smoothed, and so is each grid of three sides. Patches without a request stay free if a grid does not
/// pay. On a planar domain, the nodes on the sides of requested patches stay from then on. Throws InputError,
/// with the place, if a named grid would fold.
void add_grids(const MappedSpec& spec, const std::vector<MappedPatch>& mapped, MeshingSetup& p);

}  // namespace delquad
