// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "delquad/mesh.h"

// This header finds the faces that lines of a plane enclose. Planar domains and given meshes use it.

namespace delquad {

/// The faces that straight lines of a plane enclose. Line l has two sides: side 2 l runs along it as given,
/// side 2 l + 1 against it. The face of a side lies on its left.
struct Arrangement {
  /// Consecutive sides with the same face on their left, from the lexicographically smallest point on.
  using Cycle = std::vector<int>;
  /// A bounded face: its outline, then the cycles around the components inside of it.
  struct Face {
    std::vector<Cycle> cycles;
    int around = -1;     ///< face in which its outline lies; -1: the unbounded one
    int component = -1;  ///< number of the connected lines that bound it
  };
  std::vector<Face> faces;     ///< in the order of their outlines' first points
  std::vector<Cycle> outside;  ///< cycles of the unbounded face
  std::vector<int> face_of;    ///< face of each side; -1: the unbounded one
  std::optional<std::array<int, 2>>
      conflict;  ///< two lines that share more than common ends; the other members are then empty

  bool has_one_face(int line) const { return face_of[2 * line] == face_of[2 * line + 1]; }
};

/// Returns the faces of lines, by the sweep of Shamos and Hoey (1976) with exact predicates in O(n log n).
/// Lines are pairs of points, no pair twice; points must not coincide. Any number of lines may meet in a
/// point; loose ends are allowed.
Arrangement arrange(const std::vector<Vec2>& points, const std::vector<std::array<int, 2>>& lines);

/// Returns the point at which a side begins.
inline int start_of(const std::vector<std::array<int, 2>>& lines, int side) {
  return lines[side / 2][side % 2];
}

}  // namespace delquad
