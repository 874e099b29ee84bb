#include "algorithms/recombination/hilbert.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "base/hilbert_place.h"
#include "base/parallel.h"

namespace delquad {

namespace {

constexpr int kBits = 16;  // of each coordinate

/// Sorts by the upper 32 bits; numbers that agree in them stay in their order. Parts of a fixed length are
/// counted and moved at once.
void sort_by_upper_half(std::vector<std::uint64_t>& keys) {
  constexpr int kDigit = 11;
  constexpr std::size_t kPart = std::size_t{1} << 17;
  using Counts = std::array<std::size_t, 1u << kDigit>;
  std::vector<std::uint64_t> sorted(keys.size());
  std::vector<Counts> parts((keys.size() + kPart - 1) / kPart);
  for (int shift = 32; shift < 64; shift += kDigit) {
    const auto digit = [&](std::uint64_t key) { return (key >> shift) & ((1u << kDigit) - 1); };
    const auto part_of = [&](std::size_t part) {
      return std::span(keys).subspan(part * kPart, std::min(kPart, keys.size() - part * kPart));
    };
    parallel_for(parts.size(), [&](std::size_t part) {
      parts[part].fill(0);
      for (const std::uint64_t key : part_of(part)) ++parts[part][digit(key)];
    });
    std::size_t place = 0;
    for (std::size_t d = 0; d < parts[0].size(); ++d) {
      for (Counts& counts : parts) place += std::exchange(counts[d], place);
    }
    parallel_for(parts.size(), [&](std::size_t part) {
      for (const std::uint64_t key : part_of(part)) sorted[parts[part][digit(key)]++] = key;
    });
    keys.swap(sorted);
  }
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
  // Position in the upper half and index in the lower.
  std::vector<std::uint64_t> keys(points.size());
  parallel_ranges(points.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec2 p = scale * (points[i] - low);
      const std::uint32_t at =
          hilbert_place(static_cast<std::uint32_t>(p.x), static_cast<std::uint32_t>(p.y));
      keys[i] = std::uint64_t{at} << 32 | i;
    }
  });
  sort_by_upper_half(keys);
  std::vector<int> order(points.size());
  parallel_ranges(points.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) order[i] = static_cast<int>(keys[i] & 0xffffffffu);
  });
  return order;
}

}  // namespace delquad
