#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "features/layers/curve_layers.h"
#include "geometry/planar/planar_model.h"

namespace delquad {

/// A patch with its layers.
struct LayeredPatch {
  PatchBoundary outline, rest;
  /// Nodes in the place of each wall; both by all of its nodes, in the order of the patch.
  std::vector<std::pair<std::vector<int>, std::vector<int>>> walls;
  std::pair<std::size_t, std::size_t> quads;  ///< in the domain
};

/// Throws InputError where a curve has layers and its mirror image has none, or others.
void check_layers_symmetric(const PlanarDomain& domain, std::span<const LayerSpec> specs,
                            const CurveLayers& layers);

/// Gives each mirror image what its master has; `layered`: by patch, empty where nothing changed. Walls on an
/// axis are the same on both sides.
void mirror_layers(PlanarDomain& domain, std::vector<LayeredPatch>& layered);

}  // namespace delquad
