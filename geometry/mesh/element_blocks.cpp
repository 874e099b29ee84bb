// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/element_blocks.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/box.h"
#include "base/disjoint_sets.h"
#include "base/hilbert_place.h"
#include "base/parallel.h"

namespace delquad {

namespace {

/// Rings of elements around cuts that the next pass cuts again, and rings with work to do.
constexpr int kBandRings = 7, kNearRings = 3;

/// Maps the plane to cells of the curve. If `turned`, its cuts cross the cuts of the other curve.
class CurveFrame {
 public:
  CurveFrame(std::span<const Vec2> points, bool turned) : turned_(turned) {
    Box<Vec2> box{turn(points[0]), turn(points[0])};
    for (const Vec2 p : points) box.add(turn(p));
    // In the turned frame the middle of the box is no corner of large cells.
    const double shift = turned ? 0.3 : 0;
    low_ = box.low - shift * box.size();
    cells_ = kMost / ((1 + shift) * std::max({box.size().x, box.size().y, 1e-300}));
  }
  std::uint32_t place(Vec2 p) const {
    const Vec2 at = cells_ * (turn(p) - low_);
    return hilbert_place(cell(at.x), cell(at.y));
  }

 private:
  static constexpr double kMost = 65535;
  Vec2 turn(Vec2 p) const { return turned_ ? Vec2{0.8 * p.x - 0.6 * p.y, 0.6 * p.x + 0.8 * p.y} : p; }
  static std::uint32_t cell(double x) { return x > 0 ? static_cast<std::uint32_t>(std::min(x, kMost)) : 0; }

  bool turned_;
  Vec2 low_;
  double cells_;
};

bool any_of(const Elements& elements, std::size_t element, const std::vector<char>& vertices) {
  return std::ranges::any_of(elements.corners(element), [&](int v) { return vertices[v] != 0; });
}

/// Adds the vertices of `rings` rings of elements around.
std::vector<char> grown(const Elements& elements, std::vector<char> vertices, int rings) {
  std::vector<char> met(elements.size(), 0), is_new(elements.size());
  for (int ring = 0; ring < rings; ++ring) {
    parallel_ranges(met.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t e = begin; e < end; ++e) is_new[e] = !met[e] && any_of(elements, e, vertices);
    });
    for (std::size_t e = 0; e < met.size(); ++e) {
      if (!is_new[e]) continue;
      met[e] = 1;
      for (const int v : elements.corners(e)) vertices[v] = 1;
    }
  }
  return vertices;
}

/// Returns the elements at these vertices (empty: all), along the curve.
std::vector<int> ordered(const Elements& elements, std::span<const Vec2> places,
                         const std::vector<char>& around) {
  const CurveFrame frame(places, !around.empty());
  constexpr std::uint64_t kOut = std::numeric_limits<std::uint64_t>::max();
  std::vector<std::uint64_t> order(elements.size(), kOut);  // place on the curve, then number
  parallel_ranges(order.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      const auto corners = elements.corners(e);
      if (around.empty() || any_of(elements, e, around))
        order[e] = std::uint64_t{frame.place(0.5 * (places[corners[0]] + places[corners[2]]))} << 32 | e;
    }
  });
  std::erase(order, kOut);
  std::ranges::sort(order);
  return {order.begin(), order.end()};
}

using Blocks = std::vector<std::vector<int>>;

/// Cuts into parts of the same length, about kBlockElements each.
Blocks cut(const std::vector<int>& order) {
  const std::size_t n = std::max<std::size_t>(order.size() / ElementBlocks::kBlockElements, 1);
  Blocks blocks;
  for (std::size_t b = 0; b < n; ++b)
    blocks.emplace_back(order.begin() + static_cast<std::ptrdiff_t>(b * order.size() / n),
                        order.begin() + static_cast<std::ptrdiff_t>((b + 1) * order.size() / n));
  return blocks;
}

/// Makes one block of each connected piece.
Blocks whole_pieces(const Elements& elements, const std::vector<int>& order, std::size_t n_vertices) {
  DisjointSets pieces(n_vertices);
  for (const int e : order)
    for (const int v : elements.corners(e)) pieces.join(elements.corners(e)[0], v);
  std::vector<int> block_of(n_vertices, -1);
  Blocks blocks;
  for (const int e : order) {
    int& block = block_of[pieces.root(elements.corners(e)[0])];
    if (block < 0) {
      if (blocks.empty() || blocks.back().size() >= ElementBlocks::kBlockElements) blocks.emplace_back();
      block = static_cast<int>(blocks.size()) - 1;
    }
    blocks[block].push_back(e);
  }
  return blocks;
}

}  // namespace

void ElementBlocks::find_owners(const Elements& elements, std::size_t n_vertices) {
  constexpr int kNobody = -2, kSeveral = -1;
  owner_.assign(n_vertices, kNobody);
  taken_.assign(elements.size(), 0);
  const auto claim = [&](std::size_t e, int block) {
    for (const int v : elements.corners(e))
      owner_[v] = owner_[v] == kNobody || owner_[v] == block ? block : kSeveral;
  };
  for (std::size_t b = 0; b < own_.size(); ++b)
    for (const int e : own_[b]) taken_[e] = 1, claim(e, static_cast<int>(b));
  for (std::size_t e = 0; e < elements.size(); ++e)
    if (!taken_[e]) claim(e, kSeveral);
  const bool first = pass_ == Pass::kFirst;
  left_.resize(n_vertices, 1);
  for (std::size_t v = 0; v < n_vertices; ++v) left_[v] = (first || left_[v] != 0) && owner_[v] == kSeveral;
}

bool ElementBlocks::next(const Elements& elements, std::span<const Vec2> places) {
  if (pass_ == Pass::kNone && elements.size() < 2 * kBlockElements) {
    pass_ = Pass::kWhole;
    own_.resize(1);
    return true;
  }
  if (pass_ == Pass::kWhole || pass_ == Pass::kLast) return false;
  pass_ = pass_ == Pass::kNone ? Pass::kFirst : pass_ == Pass::kFirst ? Pass::kAcross : Pass::kLast;
  const bool first = pass_ == Pass::kFirst;
  if (!first && std::ranges::find(left_, 1) == left_.end()) return false;
  if (!first) near_ = grown(elements, left_, kNearRings);
  const std::vector<int> order = ordered(
      elements, places, first ? std::vector<char>{} : grown(elements, near_, kBandRings - kNearRings));
  own_ = pass_ == Pass::kLast ? whole_pieces(elements, order, places.size()) : cut(order);
  find_owners(elements, places.size());
  return true;
}

void ElementBlocks::renumber(std::span<const int> numbers, std::size_t n) {
  std::vector<char> left(n, 0);
  for (std::size_t v = 0; v < numbers.size(); ++v)
    if (numbers[v] >= 0) left[numbers[v]] = left_[v];
  left_ = std::move(left);
}

}  // namespace delquad
