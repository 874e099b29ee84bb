// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "features/layers/layer_walls.h"

// This header builds the quads of layers of a patch. The other files of this folder use it.

namespace delquad {

/// A patch with its layers.
struct LayeredPatch {
  PatchBoundary outline;  ///< as before, with the new nodes of walls
  PatchBoundary rest;     ///< boundary of the remaining area
  /// Old and new nodes of each wall, in the order of the patch.
  std::vector<std::pair<std::vector<int>, std::vector<int>>> walls;
  std::pair<std::size_t, std::size_t>
      quads;  ///< indices of the domain: the first quad, and the one after the last
};

/// Puts the nodes and quads of a patch's layers into its domain, and returns the patch.
LayeredPatch build_layers(PlanarDomain& domain, const PatchLayers& layers, LayerWalls& walls);

}  // namespace delquad
