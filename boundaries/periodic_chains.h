#pragma once

#include <vector>

#include "boundaries/curve_nodes.h"

namespace delquad {

/// A piece of a curve that gets the images of the nodes of another.
struct ChainPair {
  int chain, master;
  bool forward;  ///< both run the same way
  Motion motion;
};

/// The pairs of pieces that periodic curves consist of. Closed ones are turned to begin at the image of their
/// master's beginning. Throws InputError for names that no curve has and for pieces without an image.
std::vector<ChainPair> pair_chains(const Mesh& fine, std::vector<CurveChain>& chains,
                                   const std::vector<PeriodicPair>& periodic);

/// How the curves are to be meshed so that each pair has as many edges: what bounds the one bounds the other.
std::vector<CurveDemand> joined_demands(std::vector<CurveDemand> demands,
                                        const std::vector<ChainPair>& pairs);

/// Where the images of the master's nodes lie: `s` of each pair's piece, both ends included.
std::vector<double> image_places(const Mesh& fine, const std::vector<CurveChain>& chains,
                                 const ChainPair& pair, const std::vector<double>& master_places);

/// Puts nodes where the images are. Throws InputError where that is off the curve.
void place_images(const Mesh& fine, const std::vector<CurveChain>& chains,
                  const std::vector<ChainPair>& pairs, SurfaceNodes& nodes);

/// The pairs of nodes by curve, as Mesh::periodic has them.
std::vector<PeriodicNodes> periodic_nodes(const std::vector<CurveChain>& chains,
                                          const std::vector<ChainPair>& pairs, const SurfaceNodes& nodes);

}  // namespace delquad
