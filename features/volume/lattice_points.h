// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "features/volume/frame_field.h"
#include "features/volume/skin.h"

// This header fills a body with points at the corners of hexahedra. The recognition of hexahedra uses them.

namespace delquad {

/// Points with their neighbors along the directions of frames.
struct Lattice {
  std::vector<Vec3> points;  ///< the vertices of the skin first
  /// By point, ascending, the best neighbors along the directions, and all that may serve. Both lists have
  /// the sides of quads.
  std::vector<std::vector<int>> best, beside;
};

/// Neighbors that points of a lattice want.
enum class Packing {
  kCubes,  ///< six, one size along the axes of the frame; the L-infinity norm
  /// Twelve of equilateral tetrahedra and octahedra, whose squares lie across the third axis, which is the
  /// normal at the skin; the Euclidean norm.
  kTetrahedra,
};

/// Returns a lattice that follows the field inside of the skin.
///
/// A front starts at the skin, as the front of squares in the plane [remacle2013]. Each point proposes a
/// point at one size along each direction of the packing. It is kept if no other is too near in the norm of
/// its frame. Then points move to where their neighbors want them, crowded points go, and the front fills
/// gaps again.
Lattice fill_with_points(const Skin& skin, const FrameField& field, Packing packing);

}  // namespace delquad
