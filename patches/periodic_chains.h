#pragma once

#include <array>
#include <vector>

#include "geometry/surface/periodic_faces.h"
#include "patches/curve_nodes.h"

namespace delquad {

/// A piece of a curve that gets the images of the nodes of another.
struct ChainPair {
  int chain, master;
  bool forward;  ///< both run the same way
  Motion motion;
};

/// The pieces of the curves around and in a face, beside those of its master.
struct ImageFace {
  FacePair pair;
  std::vector<ChainPair> chains;  ///< a piece may be its own image
};

/// What is an image on the curves.
struct ChainPairs {
  std::vector<ChainPair> pairs;  ///< each image once, behind the pair that its master is the image of
  std::vector<ImageFace> faces;
};

/// The pairs of pieces that periodic sides consist of, once match_corners() was there. `cut_face`: of each
/// curve, -1 where it is no cut. Throws InputError for names that no curve has, for pieces without an image,
/// and where images of images do not agree.
ChainPairs pair_chains(const SurfaceModel& model, const std::vector<CurveChain>& chains,
                       const std::vector<int>& cut_face, const PeriodicSides& periodic);

/// How the curves are to be meshed so that each pair has as many edges: what bounds the one bounds the other.
std::vector<CurveDemand> joined_demands(std::vector<CurveDemand> demands,
                                        const std::vector<ChainPair>& pairs);

/// Where the images of the master's nodes lie: `s` of each pair's piece, both ends included.
std::vector<double> image_places(const Mesh& fine, const std::vector<CurveChain>& chains,
                                 const ChainPair& pair, const std::vector<double>& master_places);

/// Puts nodes where the images are. Throws InputError where that is off the curve.
void place_images(const SurfaceModel& model, const std::vector<CurveChain>& chains,
                  const std::vector<ChainPair>& pairs, SurfaceNodes& nodes);

/// The pairs of nodes by curve, as Mesh::periodic has them.
std::vector<PeriodicNodes> periodic_nodes(const std::vector<CurveChain>& chains,
                                          const std::vector<ChainPair>& pairs, const SurfaceNodes& nodes);
/// By face, as Mesh::periodic_faces has them, without the nodes inside.
std::vector<PeriodicFaces> periodic_faces(const std::vector<ImageFace>& faces, const SurfaceNodes& nodes);

}  // namespace delquad
