#pragma once

#include <string>
#include <utility>
#include <vector>

#include "geometry/surface/periodic_faces.h"
#include "geometry/surface/surface_model.h"

namespace delquad {

/// Images may lie so far from what they are images of, in diagonals of the model.
inline constexpr double kPeriodicTolerance = 1e-6;

/// The curves that bear the name, or have that number as it is in files: "curve_7". Throws InputError for a
/// name that none has.
std::vector<char> curves_named(const Mesh& fine, const PeriodicPair& pair, const std::string& name);

/// The lines of two sides, as indices into fine.lines, and what takes those of the one to the other.
struct PairedLines {
  std::vector<int> from, to;
  Motion motion;
  PeriodicPair of;  ///< who asked for it, for messages
};
/// How many pairs there are: first those of curves, then those of faces.
std::size_t n_pairs(const PeriodicSides& sides);
/// Of the n-th pair; of faces the lines around and in them. Curves from `n_curves` on are cuts, and do not
/// count.
PairedLines paired_lines(const Mesh& fine, const PeriodicSides& sides, std::size_t pair,
                         std::size_t n_curves);

/// Sees to it that images of corners are corners, and adds one to closed curves that have none. Returns
/// pairs (triangle that was split, half that was added). Throws InputError where the image of a corner is
/// off the other side.
std::vector<std::pair<int, int>> match_corners(SurfaceModel& model, const PeriodicSides& sides,
                                               std::size_t n_curves);

}  // namespace delquad
