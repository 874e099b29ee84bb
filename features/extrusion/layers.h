// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "delquad/mesh.h"
#include "features/extrusion/section.h"

// This header moves the points of a section to layers. Sweeps use it.

namespace delquad {

/// The points of the section, once for each layer of nodes, one layer after the other.
struct LayeredPoints {
  std::vector<Vec3> points;
  int n_layers = 0;          ///< of hexahedra
  bool is_closed = false;    ///< the first layer of nodes follows the last one
  bool is_straight = false;  ///< each point of the section moves along a straight line
};

/// Returns the ends of layers as shares of the way, from 0 to 1; each layer is `growth` times as high as the
/// previous one. Throws InputError unless `growth` is finite and above 0.
std::vector<double> layer_ends(int number, double growth);

/// Returns the points of all layers. Throws InputError, with the expected values, for a path or numbers of
/// layers out of range, see hexahedra.h.
LayeredPoints place_layers(const Section& section, const SweepPath& path, const SweepLayers& layers);

/// Returns the shift of each point if all quads around it move along their normals by 1. It is m with m . n =
/// 1 for each normal n, exact for up to two normals, else by least squares. Directions with hardly any normal
/// do not count there. Throws InputError, with the place, if quads fold back on each other, or touch in a
/// single point. Own method.
std::vector<Vec3> offset_directions(const Section& section);

}  // namespace delquad
