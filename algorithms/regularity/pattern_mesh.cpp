// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cassert>

#include "algorithms/regularity/patterns.h"
#include "algorithms/regularity/polygon_sides.h"

namespace delquad {

namespace {

/// Row of vertices, both ends included.
using Row = std::vector<int>;

Row part(const Row& row, int from, int to) { return {row.begin() + from, row.begin() + to + 1}; }
Row reversed(Row row) {
  std::ranges::reverse(row);
  return row;
}
/// Joins two rows; the second begins at the end of the first.
Row joined(Row row, const Row& more) {
  row.insert(row.end(), more.begin() + 1, more.end());
  return row;
}
int length(const Row& row) { return static_cast<int>(row.size()) - 1; }

/// Polygon to fill.
struct Loop {
  std::vector<int> vertex, turn;
};

class PatternMesher {
 public:
  explicit PatternMesher(const std::vector<Vec2>& rim) : n_rim_(rim.size()), points_(rim) {}

  void fill(const Loop& loop, const Pattern& pattern) {
    if (pattern.kind == Pattern::kCut) return cut(loop, pattern);
    const PolygonSides sides = sides_of(loop.turn).value();
    const int n = static_cast<int>(loop.vertex.size());
    std::vector<Row> rows;
    int at = sides.start;
    for (const int edges : sides.edges) {
      Row& row = rows.emplace_back();
      for (int i = 0; i <= edges; ++i) row.push_back(loop.vertex[(at + i) % n]);
      at += edges;
    }
    if (pattern.kind == Pattern::kGrid)
      grid(rows[0], rows[1], rows[2], rows[3]);
    else if (pattern.kind == Pattern::kStar)
      star(rows, pattern.places[0]);
    else
      corner(rows, pattern);
  }

  PatternMesh result() && {
    return {{points_.begin() + static_cast<std::ptrdiff_t>(n_rim_), points_.end()}, std::move(quads_)};
  }

 private:
  int add(Vec2 at) {
    points_.push_back(at);
    return static_cast<int>(points_.size()) - 1;
  }
  /// Adds a straight row of n edges between two vertices.
  Row line(int from, int to, int n) {
    Row row{from};
    for (int i = 1; i < n; ++i)
      row.push_back(add((double(n - i) / n) * points_[from] + (double(i) / n) * points_[to]));
    row.push_back(to);
    return row;
  }

  /// Fills a grid; the rows run counterclockwise around it.
  void grid(const Row& south, const Row& east, const Row& north, const Row& west) {
    const int n = length(south), m = length(east);
    std::vector<Row> rows(m + 1, Row(n + 1));
    rows[0] = south, rows[m] = reversed(north);
    for (int j = 1; j < m; ++j) {
      rows[j][0] = west[m - j], rows[j][n] = east[j];
      const double v = double(j) / m;
      for (int i = 1; i < n; ++i) {
        const double u = double(i) / n;
        const auto at = [&](int w) { return points_[w]; };
        const Vec2 across = (1 - v) * at(south[i]) + v * at(north[n - i]);
        const Vec2 along = (1 - u) * at(west[m - j]) + u * at(east[j]);
        const Vec2 corners = (1 - v) * ((1 - u) * at(south[0]) + u * at(south[n])) +
                             v * (u * at(north[0]) + (1 - u) * at(north[n]));
        rows[j][i] = add(across + along - corners);
      }
    }
    for (int j = 0; j < m; ++j)
      for (int i = 0; i < n; ++i)
        quads_.push_back({rows[j][i], rows[j][i + 1], rows[j + 1][i + 1], rows[j + 1][i]});
  }

  void star(const std::vector<Row>& sides, Vec2 centre) {
    const int n = static_cast<int>(sides.size());
    std::vector<int> lengths;
    for (const Row& side : sides) lengths.push_back(length(side));
    const std::array<int, 5> foot = star_feet(lengths).value();
    int short_arm = 0;
    while (short_arm < n && foot[(short_arm + 1) % n] > 0) ++short_arm;
    const int middle = short_arm < n ? sides[short_arm][foot[short_arm]] : add(centre);
    std::vector<Row> arms;
    for (int i = 0; i < n; ++i) {
      const int edges = foot[(i + 1) % n];
      if (i == short_arm)
        arms.push_back({middle});
      else if ((i + 1) % n == short_arm)
        arms.push_back(part(sides[short_arm], 0, edges));
      else if (i == (short_arm + 1) % n && short_arm < n)
        arms.push_back(reversed(part(sides[short_arm], lengths[short_arm] - edges, lengths[short_arm])));
      else
        arms.push_back(line(sides[i][foot[i]], middle, edges));
    }
    for (int i = 0; i < n; ++i) {
      const int before = (i + n - 1) % n;
      if (i == short_arm || before == short_arm) continue;
      grid(part(sides[before], foot[before], lengths[before]), part(sides[i], 0, foot[i]), arms[i],
           reversed(arms[before]));
    }
  }

  void corner(const std::vector<Row>& sides, const Pattern& p) {
    const int n = static_cast<int>(sides.size()), before = (p.at + n - 1) % n;
    const Row& ahead = sides[p.at];
    const Row& behind = sides[before];
    const int left = length(behind) - p.back, three = add(p.places[0]);
    const Row in = line(ahead[p.along], three, p.back), out = line(three, behind[left], p.along);
    grid(part(behind, left, length(behind)), part(ahead, 0, p.along), in, out);
    std::vector<Row> rest{joined(reversed(out), reversed(in)), part(ahead, p.along, length(ahead))};
    for (int i = 1; i < n - 1; ++i) rest.push_back(sides[(p.at + i) % n]);
    rest.push_back(part(behind, 0, left));
    star(rest, p.places[1]);
  }

  void cut(const Loop& loop, const Pattern& p) {
    const int n = static_cast<int>(loop.vertex.size());
    const Row row = line(loop.vertex[p.at], loop.vertex[p.to], p.cut);
    const auto fill_part = [&](int from, int to, int turn_from, int turn_to, const Row& back,
                               const Pattern& own) {
      Loop half{{loop.vertex[from]}, {turn_from}};
      for (int i = (from + 1) % n; i != to; i = (i + 1) % n)
        half.vertex.push_back(loop.vertex[i]), half.turn.push_back(loop.turn[i]);
      half.vertex.push_back(loop.vertex[to]), half.turn.push_back(turn_to);
      for (int i = 1; i < length(back); ++i) half.vertex.push_back(back[i]), half.turn.push_back(0);
      fill(half, own);
    };
    fill_part(p.at, p.to, 2 - p.along, 2 - p.back, reversed(row), p.parts[0]);
    // At an end, both parts together have the quads of the whole.
    fill_part(p.to, p.at, loop.turn[p.to] + p.back, loop.turn[p.at] + p.along, row, p.parts[1]);
  }

  std::size_t n_rim_;
  std::vector<Vec2> points_;
  std::vector<std::array<int, 4>> quads_;
};

}  // namespace

PatternMesh mesh_pattern(const Outline& outline, const Pattern& pattern) {
  assert(outline.delta.size() == outline.places.size() && outline.turn.size() == outline.places.size());
  Loop loop{{}, outline.turn};
  for (std::size_t i = 0; i < outline.places.size(); ++i) loop.vertex.push_back(static_cast<int>(i));
  PatternMesher mesher(outline.places);
  mesher.fill(loop, pattern);
  return std::move(mesher).result();
}

}  // namespace delquad
