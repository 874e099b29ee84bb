// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/regularity/polygon_sides.h"

#include <numeric>

namespace delquad {

std::optional<PolygonSides> sides_of(std::span<const int> turn) {
  const int n = static_cast<int>(turn.size());
  PolygonSides sides;
  sides.start = -1;
  for (int i = 0; i < n && sides.start < 0; ++i)
    if (turn[i] == 1) sides.start = i;
  if (sides.start < 0) return std::nullopt;
  for (int i = 0; i < n; ++i) {
    const int t = turn[(sides.start + i) % n];
    if (t < 0) return std::nullopt;
    if (t == 1) sides.edges.push_back(0);
    ++sides.edges.back();
  }
  if (sides.edges.size() < 2) return std::nullopt;
  return sides;
}

namespace {

template <int n>
std::optional<std::array<int, 5>> feet_of(std::span<const int> sides) {
  const auto after_next = [](int i) { return i + 2 < n ? i + 2 : i + 2 - n; };
  // Solves x[i + 2] = sides[i] - x[i], n times around.
  int sum = 0;
  for (int k = 0, i = 0; k < n; ++k, i = after_next(i)) sum = sides[i] - sum;
  if (sum < 0 || sum % 2 != 0) return std::nullopt;
  std::array<int, 5> x{};
  int on_rim = 0;
  for (int k = 0, i = 0, value = sum / 2; k < n; ++k, i = after_next(i)) {
    on_rim += value == 0 ? 1 : 0;
    if (value < 0 || on_rim > (n == 5 ? 1 : 0)) return std::nullopt;
    x[i] = value;
    value = sides[i] - value;
  }
  return x;
}

}  // namespace

std::optional<std::array<int, 5>> star_feet(std::span<const int> sides) {
  return sides.size() == 3 ? feet_of<3>(sides) : feet_of<5>(sides);
}

std::array<int, 5> sides_without_corner(std::span<const int> sides, int at, int along, int back) {
  const int n = static_cast<int>(sides.size());
  std::array<int, 5> rest{along + back, sides[at] - along};
  for (int i = 1; i < n - 1; ++i) rest[i + 1] = sides[(at + i) % n];
  rest[n] = sides[(at + n - 1) % n] - back;
  return rest;
}

CornerGrids corner_grids(std::span<const int> s, int at) {
  const int n = static_cast<int>(s.size()), ahead = s[at], behind = s[(at + n - 1) % n];
  if (std::reduce(s.begin(), s.end()) % 2 != 0) return {};
  // No foot of an arm may lie before the start of its side.
  if (n == 2)
    return {std::max(1, (ahead - behind) / 2 + 1), std::max(1, (behind - ahead) / 2 + 1), ahead - 1,
            behind - 1};
  const int next = s[(at + 1) % n], across = s[(at + 2) % n];
  if (ahead + behind < next + across) return {};
  const int skew = across + behind - ahead - next;
  return {std::max(1, -skew / 2), std::max(1, skew / 2),
          std::min(ahead - 1, (ahead + next + across - behind) / 2),
          std::min(behind - 1, (next + across + behind - ahead) / 2)};
}

int least_irregular_of(std::span<const int> s) {
  if (s.size() == 3 || s.size() == 5) return star_feet(s) ? 1 : -1;
  if (s.size() == 4 && s[0] == s[2] && s[1] == s[3]) return 0;
  const bool found = (s.size() == 2 || s.size() == 4) && any_corner(s, [](auto&&...) { return true; });
  return found ? 2 : -1;
}

}  // namespace delquad
