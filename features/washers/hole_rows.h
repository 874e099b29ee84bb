// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "base/box_tree.h"
#include "base/warning.h"
#include "delquad/fields.h"
#include "delquad/model.h"

// This header plans rows of quads around holes. Features use it.

namespace delquad {

/// Outlines that turn by more at a point, in radians, have a corner there.
inline constexpr double kMostTurn = 50 * std::numbers::pi / 180;

/// A smooth and convex outline of a hole.
struct Hole {
  std::vector<Vec3> outline;    ///< once around, without repetition of the first point
  std::vector<double> parts;    ///< lengths of its curves, in order
  double diameter = 0;          ///< for an oval the least width
  std::vector<int> given = {};  ///< given numbers of edges of its parts; 0: free
  bool is_rim = false;          ///< other faces continue there
  double length() const;
  Vec3 middle() const;
};
/// Returns the diameter of an outline; nothing if it has corners or is not convex.
std::optional<double> hole_diameter(const std::vector<Vec3>& outline);

/// Distances of a hole from everything else that bounds its region.
class HoleClearance {
 public:
  struct Wall {
    std::array<Vec3, 2> ends;
    int hole = -1;  ///< index of a hole with rows; -1: another wall
  };
  explicit HoleClearance(std::vector<Wall> walls);
  /// Returns the distances of a hole from other walls, and from other holes with rows, each at most `reach`.
  std::array<double, 2> around(const Hole& hole, int number, double reach) const;

 private:
  std::vector<Wall> walls_;
  BoxTree<Vec3> tree_;
};

/// Rows around a hole.
struct HoleRows {
  int rows = 0;
  double height = 0;       ///< of each
  std::vector<int> edges;  ///< on each part of the outline
};
/// Returns the first washer whose range of diameters has the hole; null: none.
const WasherSpec* washer_of(const std::vector<WasherSpec>& washers, const Hole& hole);
/// Warns of washers without a hole, given the diameters of all holes.
void warn_of_idle(const std::vector<WasherSpec>& washers, const std::vector<double>& diameters,
                  std::vector<Warning>& warnings);
/// Returns the size at the rim of a hole: the size of the field, or less if curvature asks for more edges.
/// Edges that are given stay. A warning tells which of them gives way.
double rim_size(const Hole& hole, const WasherSpec& washer, const SizeSpec& spec, const SizeField& field,
                std::vector<Warning>& warnings);
/// Returns whether edges are about as long as the size, so that quads beside them stay within QuadLimits.
bool edge_fits(double length, double size);
/// Returns the edges of parts with these lengths; opposite parts of equal lengths get equal numbers.
std::vector<int> share_edges(const std::vector<double>& parts, int edges);
/// Returns the rows of a hole, fewer or lower if there is less room, or if edges around the last row would be
/// too long. One row stays free beside walls and between two holes with rows. If no rows of at least 0.6 of
/// their height fit, the number of edges with the nearest ratio is taken. Returns nothing if none fits.
/// Warnings tell of every change. Own method.
std::optional<HoleRows> rows_around(const Hole& hole, int number, const WasherSpec& washer, double size,
                                    const HoleClearance& room, std::vector<Warning>& warnings);
/// Returns rows as layers on curves with these numbers.
LayerSpec layers_of(const HoleRows& rows, const std::vector<int>& curves, const std::string& where);

}  // namespace delquad
