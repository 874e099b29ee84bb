// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "delquad/mesh.h"

// This header divides meshes into blocks for threads. Geometry and smoothing use it.

namespace delquad {

/// Elements by one number: quads first, then triangles.
struct Elements {
  std::span<const std::array<int, 4>> quads;
  std::span<const std::array<int, 3>> triangles = {};

  std::size_t size() const { return quads.size() + triangles.size(); }
  std::span<const int> corners(std::size_t element) const {
    return element < quads.size() ? std::span<const int>(quads[element])
                                  : std::span<const int>(triangles[element - quads.size()]);
  }
};

/// Divides elements into blocks that threads work on independently, the same for every number of threads (own
/// method). Few elements, less than twice kBlockElements, are one block. Others are cut along a Hilbert
/// curve. The elements around its cuts are then cut along another curve, which crosses the first cuts. The
/// elements around the points where both cross are not cut at last. A vertex with elements of several blocks,
/// or of a block and no block, belongs to none.
class ElementBlocks {
 public:
  static constexpr int kBlockElements = 16384;

  /// Makes the blocks of the next pass. `places` are the places of the vertices in some plane. Returns false
  /// if every vertex has belonged to a block.
  bool next(const Elements& elements, std::span<const Vec2> places);

  std::size_t size() const { return own_.size(); }
  /// Returns the elements of a block, along the curve.
  std::span<const int> operator[](std::size_t block) const { return own_[block]; }
  /// Returns whether the only block has all elements, in their order.
  bool is_whole() const { return pass_ == Pass::kWhole; }
  /// Returns whether a block of this pass has the element.
  bool has_element(std::size_t element) const { return taken_[element] != 0; }
  /// Returns the block that a vertex belongs to; negative: none.
  int owner(std::size_t vertex) const { return owner_[vertex]; }
  /// Returns whether there is still work to do at a vertex: in the first pass everywhere, then near its cuts.
  bool is_near(std::size_t vertex) const { return near_.empty() || near_[vertex] != 0; }
  /// Renumbers the vertices before the next pass (-1: removed); `n` is their new number.
  void renumber(std::span<const int> numbers, std::size_t n);

 private:
  enum class Pass { kNone, kWhole, kFirst, kAcross, kLast };
  void find_owners(const Elements& elements, std::size_t n_vertices);

  Pass pass_ = Pass::kNone;
  std::vector<std::vector<int>> own_;
  std::vector<char> taken_;  ///< by element
  std::vector<int> owner_;   ///< by vertex
  std::vector<char> left_;   ///< by vertex: whether no block of any pass so far has it
  std::vector<char> near_;   ///< by vertex
};

}  // namespace delquad
