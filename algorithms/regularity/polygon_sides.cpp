#include "algorithms/regularity/polygon_sides.h"

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

std::optional<std::array<int, 5>> star_feet(std::span<const int> sides) {
  const int n = static_cast<int>(sides.size());
  // x[i + 2] = sides[i] - x[i], n times around.
  int sum = 0;
  for (int k = 0, i = 0; k < n; ++k, i = (i + 2) % n) sum = sides[i] - sum;
  if (sum <= 0 || sum % 2 != 0) return std::nullopt;
  std::array<int, 5> x{};
  for (int k = 0, i = 0, value = sum / 2; k < n; ++k) {
    if (value < 1 || value >= sides[i]) return std::nullopt;
    x[i] = value;
    value = sides[i] - value;
    i = (i + 2) % n;
  }
  return x;
}

std::array<int, 5> sides_without_corner(std::span<const int> sides, int at, int along, int back) {
  const int n = static_cast<int>(sides.size());
  std::array<int, 5> rest{along + back, sides[at] - along};
  for (int i = 1; i < n - 1; ++i) rest[i + 1] = sides[(at + i) % n];
  rest[n] = sides[(at + n - 1) % n] - back;
  return rest;
}

}  // namespace delquad
