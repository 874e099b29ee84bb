// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "features/periodic/periodic.h"

// This header pairs faces and their lines. Periodic sides of surfaces use it.

namespace delquad {

/// Returns the image of each face of `from` among the faces of `to`. Throws InputError if there is none, or
/// if both are too far apart. The limit is kPeriodicTolerance diagonals of the model, and on triangulations
/// the possible distance between chords of one surface.
std::vector<FacePair> pair_faces(const SurfaceModel& model, const std::vector<int>& from,
                                 const std::vector<int>& to, const PeriodicPair& pair);

/// Largest distance of an image from the moved original, in diagonals of the model.
inline constexpr double kPeriodicTolerance = 1e-6;

/// Rounds in which images of corners become corners, whose images become corners, and so on.
inline constexpr int kRoundsOfChains = 8;

/// Returns the two points of a line, the lower first.
inline std::array<int, 2> side_of(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// The lines of two sides, as indices into fine.lines.
struct PairedLines {
  std::vector<int> from, to;
  PeriodicPair of;  ///< the request
};
/// Returns the number of pairs: pairs of curves come first, then pairs of faces.
std::size_t n_pairs(const PeriodicSides& sides);
/// Returns pair number `pair`; for faces the lines around and in them. Curves from `n_curves` on are cuts,
/// and do not count.
PairedLines paired_lines(const Mesh& fine, const PeriodicSides& sides, std::size_t pair,
                         std::size_t n_curves);

}  // namespace delquad
