// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "geometry/patches/surface_curves.h"
#include "geometry/patches/surface_domain.h"
#include "geometry/planar/curve_pieces.h"
#include "geometry/surface/flatten.h"

/// This header has periodic sides, which have the same nodes. The preparation calls its functions in this
/// order.
namespace delquad {

/// A face that gets the mesh of another, moved.
struct FacePair {
  int face, master;  ///< indices into SurfaceModel::fine.regions
  bool is_reversed;  ///< the moved triangles of the master look away from the face
  PeriodicPair of;   ///< who asked for it, and the motion that takes the master there
};

/// In what a surface model is periodic.
struct PeriodicSides {
  std::vector<PeriodicPair> curves;
  std::vector<FacePair> faces;
  bool empty() const { return curves.empty() && faces.empty(); }
};

/// Returns the periodic sides of a surface model: faces where both names belong to faces, else curves. Throws
/// InputError for names that nothing has, for faces that do not match and for faces of two pairs.
PeriodicSides find_periodic_sides(const SurfaceModel& model, const std::vector<PeriodicPair>& asked,
                                  std::vector<Warning>& warnings);

/// Flattens all faces but the images of others. Makes images of corners corners, too, and gives closed curves
/// of pairs one. Throws InputError where the image of a corner is off the other side.
Flattening flatten_periodic(SurfaceModel& model, const PeriodicSides& periodic);

/// Pieces of curves on two sides.
struct PairedChains {
  std::vector<int> from, to;
  PeriodicPair of;  ///< who asked for it
};

/// The images on the curves.
struct ChainPairs {
  std::vector<ChainPair> pairs;                  ///< each image once, behind the pair of its master
  std::vector<std::vector<ChainPair>> of_sides;  ///< all of each pair of sides; a piece may be its own image
};

/// Throws InputError for pieces without an image, and where images of images do not agree.
ChainPairs pair_chains(const Mesh& fine, const std::vector<CurveChain>& chains,
                       const std::vector<PairedChains>& sides);
/// Returns the pairs of pieces that periodic sides consist of, of a model that was flattened so. `cut_face`:
/// of each curve, -1 where it is no cut.
ChainPairs pair_chains(const SurfaceModel& model, const std::vector<CurveChain>& chains,
                       const std::vector<int>& cut_face, const PeriodicSides& periodic);

/// Pairs the pieces of periodic curves, and puts the ends of those that are images where these are. `chains`:
/// the nodes of the pieces in `lines`. Throws InputError as pair_chains(), and for regions.
std::vector<ChainPair> pair_pieces(const PlanarModel& model, const std::vector<PeriodicPair>& periodic,
                                   const Mesh& lines, const std::vector<CurveChain>& chains, ModelChain& ends,
                                   std::vector<CurvePiece>& pieces);

/// Puts the nodes of images where the nodes of their masters are; both have as many edges.
void place_as_masters(const Mesh& fine, const SurfaceCurves& curves,
                      const std::vector<SizeIntegral>& integrals, CurvePlaces& places);

/// Puts nodes where the images are. Throws InputError where that is off the curve.
void place_images(const SurfaceModel& model, const SurfaceCurves& curves, SurfaceNodes& nodes);

/// Gives pieces the images of the nodes of their masters. Throws InputError where they are off the piece.
void follow_masters(const PlanarModel& model, const std::vector<ChainPair>& images,
                    std::vector<CurvePiece>& pieces);

/// Adds the pairs of nodes by curve. `nodes`: of each chain.
void add_pairs_of_chains(const std::vector<CurveChain>& nodes, const std::vector<ChainPair>& pairs,
                         std::vector<PeriodicNodes>& all);
/// Adds the pairs of nodes by curve and by face, without nodes inside of faces. Images of faces get the
/// sharp corners of their masters. `of_sides`: see ChainPairs.
void add_pairs(const SurfaceCurves& curves, const PeriodicSides& periodic,
               const std::vector<std::vector<ChainPair>>& of_sides, SurfaceDomain& domain);

/// Gives the faces of `mesh.periodic_faces` the elements of their masters, moved, which must be there, and
/// adds the nodes inside to the pairs. Faces that are `left_out` (by region) lose their pair.
void add_face_images(const std::vector<char>& left_out, Mesh& mesh);

}  // namespace delquad
