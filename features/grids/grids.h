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

/// A part of a face's outline between two nodes that any mesh has, the face on its left.
struct OutlinePart {
  int curve;     ///< a piece of one, whose number of edges is to be chosen
  int node;      ///< at which it begins
  Vec3 at;       ///< that node
  double angle;  ///< inside of the face, there; radians
  double ideal;  ///< edges
};
using FaceOutline = std::vector<std::vector<OutlinePart>>;  ///< loops, the outer one first

/// A face that is to become a grid of four sides, three grids around a middle of three, or a ring.
struct MappedFace {
  int face;
  bool is_requested;  ///< by name, and not found
  std::vector<std::vector<int>>
      sides;                        ///< four or three, of curves, one after the other; of a ring its loops
  std::vector<std::size_t> begins;  ///< where in the outline they begin, ascending; of a ring: none
  int rows = 0;                     ///< see MappedSpec::rings; 0: no one told
};

/// Finds the faces that become grids, and their corners. Given points are corners. Else a face with just
/// three nodes that turn by more than 30 degrees, or three nodes at all, has these. Any other face has the
/// four nodes at which it turns most as a rectangle does. Two loops that turn nowhere are a ring.
/// Faces that `automatic` asks for have four corners within 35 degrees of right angles, and other nodes
/// within 30 degrees of straight. The wanted numbers of edges of their opposite sides differ at most by a
/// factor of two, or by one. The same limits hold for narrow faces that become grids unasked. They are
/// strips, up to two and a half sizes wide and longer than that, and rings of that width.
class GridFinder {
 public:
  using NamedPlaces = std::vector<std::pair<std::string, Vec3>>;
  /// Throws InputError for names that no region has. The arguments outlive this object.
  GridFinder(const MappedSpec& spec, const std::vector<Entity>& regions, const NamedPlaces& points);

  /// Returns the grid of a face; nothing where the face stays free. `quads`: as many as its area holds.
  /// Throws InputError where a named one cannot be a grid.
  std::optional<MappedFace> find(int face, const Entity& region, const FaceOutline& outline, double quads);
  /// Throws InputError for corners that lie on no outline.
  void finish() const;

 private:
  struct Corners {
    const GridCorners* asked;
    std::vector<Vec3> at;
    bool is_used = false;
    std::string missing;  ///< why they are no nodes of an outline
  };
  std::vector<std::size_t> requested_corners(const Entity& region, const FaceOutline& outline);

  const MappedSpec& spec_;
  std::vector<Corners> corners_;
};

/// Chooses numbers of edges, see balance_counts(). `around`: of each face its curves, each as often as it
/// lies beside; `leader`: of each curve the one whose number it has. Faces that are not asked for become free
/// where the others cannot agree with them.
std::vector<UnbalancedFace> balance_grids(std::vector<CountedCurve>& curves,
                                          const std::vector<std::vector<int>>& around,
                                          const std::vector<int>& leader, std::vector<MappedFace>& mapped);

/// Returns why it cannot be balanced. `mapped`: null of a free face. `curves`: with the numbers of edges that
/// they have, `names` what they are called.
std::string why_unbalanced(const UnbalancedFace& bad, const std::string& label, const MappedFace* mapped,
                           const std::vector<CountedCurve>& curves, const std::vector<std::string>& names);

/// Returns the patches (MappedFace::face) that become grids of their faces, see GridFinder. A face that was
/// cut open into one patch may be a tube, with the cut on two opposite sides. Throws InputError as GridFinder
/// does, and for a named face of several patches.
std::vector<MappedFace> find_surface_grids(const MappedSpec& spec, const Mesh& fine,
                                           const SurfaceCurves& curves, const CurveDemands& wanted);

/// Numbers of edges of chains so that mapped patches have what they need, and the others an even number
/// around. Patches for which that cannot be are `odd_patches`. Patches that are not asked for may drop out of
/// `mapped`. Throws InputError where a named face cannot be a grid.
std::vector<int> grid_counts(const MappedSpec& spec, const Mesh& fine, const SurfaceCurves& curves,
                             const CurveDemands& wanted, std::vector<MappedFace>& mapped,
                             std::vector<int>& odd_patches);

/// Returns whether opposite sides, or the loops of a ring, have as many edges.
bool is_balanced(const MappedFace& face, const std::vector<int>& counts);

/// Returns the same by the places where sides begin on the patches' boundaries.
std::vector<MappedPatch> grid_patches(const std::vector<MappedFace>& mapped, const SurfaceCurves& curves,
                                      const std::vector<int>& counts);

/// Returns the same of a planar domain whose curves were meshed. Chain i of `curves` is piece i.
std::vector<MappedPatch> mapped_patches(const std::vector<MappedFace>& mapped, const SurfaceCurves& curves,
                                        const std::vector<CurvePiece>& pieces, const Arrangement& arrangement,
                                        const FaceRegions& regions);

/// Gives patches that are to be grids theirs. In the plane, and in the parameter plane of a surface, nodes
/// come from transfinite interpolation. On a surface they also come from interpolation in space, each in the
/// nearest point of the patch. There the grid counts whose quads are better in space in the mean. A grid that
/// would fold is smoothed, and so is each grid of three sides. Patches that were not asked for stay free
/// where that does not pay. On a planar domain, the nodes on the sides of requested patches stay from then
/// on. Throws InputError, with the place, where a named one would fold.
void add_grids(const MappedSpec& spec, const std::vector<MappedPatch>& mapped, MeshingSetup& p);

}  // namespace delquad
