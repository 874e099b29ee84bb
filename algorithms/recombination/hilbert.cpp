#include "algorithms/recombination/hilbert.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace delquad {

namespace {

constexpr int kBits = 16;  // of each coordinate

/// Position along the curve of cell (x, y).
std::uint32_t curve_position(std::uint32_t x, std::uint32_t y) {
  std::uint32_t position = 0;
  for (std::uint32_t s = 1u << (kBits - 1); s > 0; s >>= 1) {
    const bool right = (x & s) != 0, upper = (y & s) != 0;
    position = 4 * position + (right ? (upper ? 2 : 3) : (upper ? 1 : 0));
    // The curve enters the two lower quarters turned: bring them to the standard attitude.
    if (!upper) {
      if (right) {
        x = ~x;
        y = ~y;
      }
      std::swap(x, y);
    }
  }
  return position;
}

}  // namespace

std::vector<int> hilbert_order(std::span<const Vec2> points) {
  if (points.empty()) return {};
  Vec2 low = points[0], high = points[0];
  for (const Vec2 p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const double extent = std::max(high.x - low.x, high.y - low.y);
  const double scale = extent > 0 ? ((1 << kBits) - 1) / extent : 0;
  // Position in the upper half and index in the lower: sorting the numbers sorts the points.
  std::vector<std::uint64_t> keys(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2 p = scale * (points[i] - low);
    keys[i] = std::uint64_t{curve_position(static_cast<std::uint32_t>(p.x), static_cast<std::uint32_t>(p.y))}
                  << 32 |
              i;
  }
  std::sort(keys.begin(), keys.end());
  std::vector<int> order(points.size());
  for (std::size_t i = 0; i < keys.size(); ++i) order[i] = static_cast<int>(keys[i] & 0xffffffffu);
  return order;
}

}  // namespace delquad
