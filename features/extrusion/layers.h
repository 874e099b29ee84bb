// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <vector>

#include "delquad/mesh.h"
#include "features/extrusion/section.h"

// This header moves the points of a section to layers. Sweeps use it.

namespace delquad {

/// Points and hexahedra at the joints of a shell.
struct FilledJoints {
  std::vector<int> same_as;  ///< by point of all layers: the point in its place
  struct Cell {
    std::array<int, 8> nodes;
    int quad;  ///< a quad at the joint with its region
  };
  std::vector<Cell> cells;
  /// Ends of joints on the boundary, counterclockwise seen from outside.
  struct End {
    std::array<int, 4> nodes;
    int point;  ///< at the end of the joint
  };
  std::vector<End> ends;
  std::vector<int> origin;  ///< point of the section for each new point
};

/// The points of the section, once for each layer of nodes, one layer after the other.
struct LayeredPoints {
  std::vector<Vec3> points;
  int n_layers = 0;                 ///< of hexahedra
  bool is_closed = false;           ///< the first layer of nodes follows the last one
  bool is_straight = false;         ///< each point of the section moves along a straight line
  std::vector<int> layers_of = {};  ///< number of layers of each region; empty: all
  std::vector<double> shares = {};  ///< of the way along normals, by layer of nodes
  double thickness = 0;             ///< along normals to both sides, above 0 with joints; else 0
  FilledJoints joints = {};

  /// Returns the number of layers of a quad.
  int height(const Section& section, int quad) const {
    return layers_of.empty() ? n_layers : layers_of[section.mesh.quad_region[quad]];
  }
};

/// Returns the ends of layers as shares of the way, from 0 to 1; each layer is `growth` times as high as the
/// previous one. Throws InputError unless `growth` is finite and above 0.
std::vector<double> layer_ends(int number, double growth);

/// Returns the points of all layers. Throws InputError, with the expected values, for a path or numbers of
/// layers out of range, see hexahedra.h.
LayeredPoints place_layers(const Section& section, const SweepPath& path, const SweepLayers& layers);

/// A corner of a quad, seen from the side of its normal (sign 1) or from the opposite side (-1).
struct SidedCorner {
  int quad, corner;
  double sign;
};
/// Returns the shift of a point as offset_directions(), for the given corners there.
Vec3 offset_direction(const Mesh& mesh, std::span<const SidedCorner> corners, const Vec3& at);

/// Returns the shift of each point if all quads around it move along their normals by 1. It is m with m . n =
/// 1 for each normal n, exact for up to two normals, else by least squares. Directions with hardly any normal
/// do not count there. Throws InputError, with the place, if quads fold back on each other, or touch in a
/// single point. Own method.
std::vector<Vec3> offset_directions(const Section& section);

}  // namespace delquad
