#pragma once

#include <span>
#include <vector>

#include "delquad/model.h"
#include "geometry/planar/planar_model.h"

namespace delquad {

/// Which layers each curve of a domain has.
struct CurveLayers {
  std::vector<std::vector<int>> of_curve;  ///< indices of layers
  std::vector<std::vector<char>> into;     ///< of each layer, by region; empty: into all
  /// That on the side of a region; -1: none.
  int at(int curve, int region) const;
};

/// Throws InputError for names that no curve or region has, for curves with several layers on one side, and
/// for those without a region, with the same one on both sides or with none of those that were named.
CurveLayers layers_of_curves(const PlanarDomain& domain, std::span<const LayerSpec> specs);

}  // namespace delquad
