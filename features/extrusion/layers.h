// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "delquad/mesh.h"
#include "features/extrusion/section.h"

// This header moves the points of a section to layers. Sweeps use it.

namespace delquad {

/// The section's points, once for each layer of nodes, which follow each other.
struct LayeredPoints {
  std::vector<Vec3> points;
  int n_layers = 0;          ///< of hexahedra
  bool is_closed = false;    ///< above the last layer of nodes comes the first one
  bool is_straight = false;  ///< each point of the section moves along a straight line
};

/// Returns where layers end, from 0 to 1: each is `growth` times as high as the one before.
std::vector<double> layer_ends(int number, double growth);

/// Throws InputError that says what was expected.
LayeredPoints place_layers(const Section& section, const SweepPath& path, const SweepLayers& layers);

/// Returns for each point the way that it goes while all quads around move along their normals by 1. It is m
/// with m . n = 1 for each normal n, solved exactly for up to two of them, else by least squares. There,
/// directions that hardly any normal has count as none. Throws InputError with the place where quads fold
/// back on each other, and where quads touch in a point only.
std::vector<Vec3> offset_directions(const Section& section);

}  // namespace delquad
