// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "geometry/patches/surface_curves.h"
#include "geometry/patches/surface_domain.h"
#include "geometry/planar/curve_pieces.h"
#include "geometry/surface/flatten.h"

// This header has periodic sides, which have the same nodes. The preparation calls its functions in this
// order.

namespace delquad {

/// A face that gets the moved mesh of another face.
struct FacePair {
  int face, master;  ///< indices into SurfaceModel::fine.regions
  bool is_reversed;  ///< normals of the moved master are opposite to normals of the face
  PeriodicPair of;   ///< the request, with the motion from the master to the face
};

/// Periodic sides of a surface model.
struct PeriodicSides {
  std::vector<PeriodicPair> curves;
  std::vector<FacePair> faces;
  bool empty() const { return curves.empty() && faces.empty(); }
};

/// Returns the periodic sides of a surface model: faces if both names belong to faces, else curves. Throws
/// InputError for unknown names, for faces that do not match, and for faces in two pairs.
PeriodicSides find_periodic_sides(const SurfaceModel& model, const std::vector<PeriodicPair>& asked,
                                  std::vector<Warning>& warnings);

/// Flattens all faces but the images of others. Makes images of corners corners, too, and gives closed curves
/// of pairs one. Throws InputError if the image of a corner is off the other side.
Flattening flatten_periodic(SurfaceModel& model, const PeriodicSides& periodic);

/// Pieces of curves on two sides.
struct PairedChains {
  std::vector<int> from, to;
  PeriodicPair of;  ///< the request
};

/// Pairs of pieces, one of which is the image of the other.
struct ChainPairs {
  std::vector<ChainPair> pairs;                  ///< each image once, after the pair of its master
  std::vector<std::vector<ChainPair>> of_sides;  ///< all pairs by pair of sides; a piece may be its own image
};

/// Returns the pairs of pieces on these sides. Throws InputError for pieces without an image, and for images
/// of images that disagree.
ChainPairs pair_chains(const Mesh& fine, const std::vector<CurveChain>& chains,
                       const std::vector<PairedChains>& sides);
/// Returns the pairs of pieces of the periodic sides of a flattened model. `cut_face` is the face of each
/// cut, and -1 for other curves.
ChainPairs pair_chains(const SurfaceModel& model, const std::vector<CurveChain>& chains,
                       const std::vector<int>& cut_face, const PeriodicSides& periodic);

/// Returns the pairs of pieces of periodic curves, and moves the ends of images to the images of ends.
/// `chains` has the nodes of the pieces in `lines`. Throws InputError as pair_chains(), and for regions.
std::vector<ChainPair> pair_pieces(const PlanarModel& model, const std::vector<PeriodicPair>& periodic,
                                   const Mesh& lines, const std::vector<CurveChain>& chains, ModelChain& ends,
                                   std::vector<CurvePiece>& pieces);

/// Moves the nodes of images to the images of their masters' nodes; both have as many edges.
void place_as_masters(const Mesh& fine, const SurfaceCurves& curves,
                      const std::vector<SizeIntegral>& integrals, CurvePlaces& places);

/// Moves nodes to the images of their originals. Throws InputError if an image is off the curve.
void place_images(const SurfaceModel& model, const SurfaceCurves& curves, SurfaceNodes& nodes);

/// Gives pieces the images of the nodes of their masters. Throws InputError if an image is off the piece.
void follow_masters(const PlanarModel& model, const std::vector<ChainPair>& images,
                    std::vector<CurvePiece>& pieces);

/// Adds the pairs of nodes by curve; `nodes` has the nodes of each chain.
void add_pairs_of_chains(const std::vector<CurveChain>& nodes, const std::vector<ChainPair>& pairs,
                         std::vector<PeriodicNodes>& all);
/// Adds the pairs of nodes by curve and by face, without nodes inside of faces. Images of faces get the sharp
/// corners of their masters. `of_sides` is as in ChainPairs.
void add_pairs(const SurfaceCurves& curves, const PeriodicSides& periodic,
               const std::vector<std::vector<ChainPair>>& of_sides, SurfaceDomain& domain);

/// Gives the faces of `mesh.periodic_faces` the moved elements of their masters, which must exist, and adds
/// the inner nodes to the pairs. Faces that are `left_out` (by region) lose their pair.
void add_face_images(const std::vector<char>& left_out, Mesh& mesh);

}  // namespace delquad
