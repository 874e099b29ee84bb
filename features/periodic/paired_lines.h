// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "features/periodic/periodic.h"

// This header pairs faces and their lines. Periodic sides of surfaces use it.

namespace delquad {

/// Returns to each face of `from` its image among the faces of `to`. Throws InputError where there is none,
/// and where the two are too far apart. The limit is 1e-6 of the model's diagonal, and on triangulations the
/// distance that chords of one surface may have.
std::vector<FacePair> pair_faces(const SurfaceModel& model, const std::vector<int>& from,
                                 const std::vector<int>& to, const PeriodicPair& pair);

/// Images may lie so far from what they are images of, in diagonals of the model.
inline constexpr double kPeriodicTolerance = 1e-6;

/// Corners of curves are images of corners that are images, and so on.
inline constexpr int kRoundsOfChains = 8;

/// Returns the two points of a line, the lower first.
inline std::array<int, 2> side_of(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// The lines of two sides, as indices into fine.lines.
struct PairedLines {
  std::vector<int> from, to;
  PeriodicPair of;  ///< who asked for it
};
/// Returns how many pairs there are: first the pairs of curves, then the pairs of faces.
std::size_t n_pairs(const PeriodicSides& sides);
/// Returns the n-th pair; for faces the lines around and in them. Curves from `n_curves` on are cuts, and do
/// not count.
PairedLines paired_lines(const Mesh& fine, const PeriodicSides& sides, std::size_t pair,
                         std::size_t n_curves);

}  // namespace delquad
