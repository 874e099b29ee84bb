// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <numbers>
#include <optional>
#include <vector>

#include "base/box_tree.h"
#include "base/warning.h"
#include "delquad/fields.h"
#include "delquad/model.h"

// This header plans rows of quads around holes. Features use it.

namespace delquad {

/// Outlines turn by no more at a point, in radians, or have a corner there.
inline constexpr double kMostTurn = 50 * std::numbers::pi / 180;

/// A smooth and convex outline of a hole.
struct Hole {
  std::vector<Vec3> outline;    ///< once around, the first point is not repeated
  std::vector<double> parts;    ///< lengths of the curves that it consists of, in their order
  double diameter = 0;          ///< of an oval one: the least width
  std::vector<int> given = {};  ///< edges of its parts, where that is settled; 0: not
  bool is_rim = false;          ///< whether other faces go on there
  double length() const;
  Vec3 middle() const;
};
/// Returns the diameter; nothing of what has corners or is not convex.
std::optional<double> hole_diameter(const std::vector<Vec3>& outline);

/// How far a hole is from all else that bounds its region.
class HoleClearance {
 public:
  struct Wall {
    std::array<Vec3, 2> ends;
    int hole = -1;  ///< that gets rows, too
  };
  explicit HoleClearance(std::vector<Wall> walls);
  /// Returns the distances from other walls, and from other holes with rows; as much as `reach` where there
  /// is nothing.
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
/// Returns the range that a hole falls into; null: none.
const WasherSpec* washer_of(const std::vector<WasherSpec>& washers, const Hole& hole);
/// Returns the size at the rim of a hole: the size of the field, or less if curvature asks for more edges.
/// Edges that are given stay. A warning tells which of them gives way.
double rim_size(const Hole& hole, const WasherSpec& washer, const SizeSpec& spec, const SizeField& field,
                std::vector<Warning>& warnings);
/// Returns whether edges are about as long as the size: neither shorter nor longer than a sheet allows.
bool edge_fits(double length, double size);
/// Returns the edges of parts with these lengths; opposite parts of equal lengths get equal numbers.
std::vector<int> share_edges(const std::vector<double>& parts, int edges);
/// Returns the rows of a hole, fewer and lower where there is less room. So they are where edges around the
/// last row would be longer than fits. To walls a row is left free, and between two holes with rows one, too.
/// Another number of edges, the next in ratio, where no rows of 0.6 of their height fit this one, or edges of
/// the rim. Nothing where none does. Warnings tell of all.
std::optional<HoleRows> rows_around(const Hole& hole, int number, const WasherSpec& washer, double size,
                                    const HoleClearance& room, std::vector<Warning>& warnings);

}  // namespace delquad
