// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/layout/layout_pieces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "algorithms/regularity/polygon_sides.h"

namespace delquad {

int corners_of(const Rim& rim) {
  int sum = 0;
  for (const RimVertex& v : rim) sum += 2 - v.quads;
  return sum;
}

std::vector<int> turns_of(const Rim& rim) {
  std::vector<int> turns;
  for (const RimVertex& v : rim) turns.push_back(2 - v.quads);
  return turns;
}

std::vector<Rim> cut_along(std::span<const Rim> rims, const FieldLine& line, std::span<const int> row) {
  const Rim& first = rims[line.from.rim];
  const Rim& second = rims[line.to.rim];
  const auto copy = [](const Rim& rim, int from, int to, Rim& into) {
    const int n = static_cast<int>(rim.size());
    for (int i = (from + 1) % n; i != to; i = (i + 1) % n) into.push_back(rim[i]);
  };
  const RimVertex start = first[line.from.at], end = second[line.to.at];
  const auto ahead = [&](Rim& into) {
    for (const int v : row) into.push_back({v, 2});
  };
  const auto back = [&](Rim& into) {
    for (std::size_t i = row.size(); i-- > 0;) into.push_back({row[i], 2});
  };
  if (line.from.rim != line.to.rim) {
    Rim all{{start.vertex, start.quads - line.along}};
    ahead(all);
    all.push_back({end.vertex, end.quads - line.back});
    copy(second, line.to.at, line.to.at, all);
    all.push_back({end.vertex, line.back});
    back(all);
    all.push_back({start.vertex, line.along});
    copy(first, line.from.at, line.from.at, all);
    return {std::move(all)};
  }
  Rim right{{start.vertex, line.along}}, left{{end.vertex, end.quads - line.back}};
  copy(first, line.from.at, line.to.at, right);
  right.push_back({end.vertex, line.back});
  back(right);
  copy(first, line.to.at, line.from.at, left);
  left.push_back({start.vertex, start.quads - line.along});
  ahead(left);
  return {std::move(right), std::move(left)};
}

bool is_convex(const Rim& rim) {
  return std::ranges::all_of(rim, [](const RimVertex& v) { return v.quads <= 2; });
}
bool is_polygon(const Rim& rim) {
  const int corners = corners_of(rim);
  return corners >= 2 && corners <= 5 && is_convex(rim);
}

namespace {

/// Pieces of six corners with more rim vertices usually have a row of edges that leaves two stars.
constexpr std::size_t kManyVertices = 36;

/// Returns whether a row of edges cuts a polygon of six sides into two stars of five sides.
bool is_two_stars(std::span<const int> s) {
  for (int i = 0; i < 3; ++i)
    for (int a = 1; a < s[i]; ++a)
      for (int b = 1; b < s[i + 3]; ++b) {
        const int most = s[i] + s[i + 1] + s[i + 2] + s[i + 3];
        for (int cut = 1 + (a + s[(i + 4) % 6] + s[(i + 5) % 6] + s[i + 3] - b + 1) % 2; cut <= most;
             cut += 2) {
          const std::array<int, 5> one{s[i] - a, s[i + 1], s[i + 2], b, cut},
              other{s[i + 3] - b, s[(i + 4) % 6], s[(i + 5) % 6], a, cut};
          if (star_feet(one) && star_feet(other)) return true;
        }
      }
  return false;
}

/// Returns the cost of the necessary irregular vertices of a piece.
double cost_of_irregular(const Rim& rim, double weight) {
  const int corners = corners_of(rim);
  return rim.size() % 2 != 0 || rim.size() < 4 || corners < 2 ? kNever : weight * std::abs(4 - corners);
}

}  // namespace

double cost_of(const Rim& rim, double weight) {
  const int corners = corners_of(rim), least = std::abs(4 - corners);
  const double irregular_cost = cost_of_irregular(rim, weight);
  const auto sides = irregular_cost < kNever && corners <= 6 ? sides_of(turns_of(rim)) : std::nullopt;
  if (!sides) return irregular_cost;
  if (corners == 6)
    return weight * (rim.size() > kManyVertices || is_two_stars(sides->edges) ? least : least + kMixed);
  const int irregular = least_irregular_of(sides->edges);
  if (irregular < 0 && corners == 4) {
    // Rows end here. A pair of irregular vertices can end as many as there is space for.
    int pairs = 1;
    for (int i = 0; i < 2; ++i) {
      const int rows = std::abs(sides->edges[i] - sides->edges[i + 2]),
                room = std::min(sides->edges[(i + 1) % 4], sides->edges[(i + 3) % 4]);
      pairs += (rows + 2 * room - 1) / (2 * std::max(1, room - 1));
    }
    return weight * 2 * pairs;
  }
  return weight * (irregular < 0 ? least + kMixed : irregular);
}

int foot_of(std::span<const int> sides, std::size_t i) {
  int sum = 0;
  for (std::size_t k = 0; k < sides.size(); ++k, i = (i + 2) % sides.size()) sum = sides[i] - sum;
  return sum;
}

double cost_of_closed(const Rim& rim, double weight) {
  const double irregular = cost_of_irregular(rim, weight);
  const auto sides = irregular < kNever ? sides_of(turns_of(rim)) : std::nullopt;
  if (!sides) return irregular;
  const std::vector<int>& s = sides->edges;
  double off = 0;
  if (s.size() == 4) {
    for (int i = 0; i < 2; ++i)
      off += std::abs(s[i] - s[i + 2]) * std::sqrt(double(s[i + 1]) * s[(i + 3) % 4]);
    return kLoss * kDeviation / 4 * off;
  }
  if (s.size() == 3 || s.size() == 5)
    for (std::size_t i = 0; i < s.size(); ++i) off = std::max(off, 2.0 - foot_of(s, i));
  return irregular + off;
}

}  // namespace delquad
