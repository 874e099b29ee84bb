// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/planar/arrangement.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

struct Lines {
  std::vector<Vec2> points;
  std::vector<std::array<int, 2>> lines;
};

bool meet(const Lines& g, std::array<int, 2> p, std::array<int, 2> q) {
  const auto at = [&](int v) { return g.points[v]; };
  const auto on = [&](int v, std::array<int, 2> l) {
    if (v == l[0] || v == l[1]) return false;
    const Vec2 a = at(l[0]), b = at(l[1]), x = at(v);
    return orient2d(a, b, x) == 0 && dot(x - a, x - b) < 0;
  };
  if (on(p[0], q) || on(p[1], q) || on(q[0], p) || on(q[1], p)) return true;
  if (p[0] == q[0] || p[0] == q[1] || p[1] == q[0] || p[1] == q[1]) return false;
  return orient2d(at(p[0]), at(p[1]), at(q[0])) * orient2d(at(p[0]), at(p[1]), at(q[1])) < 0 &&
         orient2d(at(q[0]), at(q[1]), at(p[0])) * orient2d(at(q[0]), at(q[1]), at(p[1])) < 0;
}

/// Points of a coarse grid, joined where no line is in the way.
Lines random_lines(std::mt19937& engine, int n_points, int n_tries) {
  Lines g;
  std::set<std::pair<int, int>> taken;
  std::uniform_int_distribution<int> coordinate(0, 8), point(0, n_points - 1);
  while (static_cast<int>(g.points.size()) < n_points) {
    const int x = coordinate(engine), y = coordinate(engine);
    if (taken.insert({x, y}).second) g.points.push_back({double(x), double(y)});
  }
  std::set<std::pair<int, int>> known;
  for (int i = 0; i < n_tries; ++i) {
    const std::array line{point(engine), point(engine)};
    if (line[0] == line[1] || known.contains(std::minmax(line[0], line[1]))) continue;
    bool free = true;
    for (const auto& other : g.lines) free = free && !meet(g, line, other);
    for (int v = 0; v < n_points; ++v)
      if (v != line[0] && v != line[1]) free = free && !meet(g, line, {v, v});
    if (!free) continue;
    known.insert(std::minmax(line[0], line[1]));
    g.lines.push_back(line);
  }
  return g;
}

double area(const Lines& g, const Arrangement::Cycle& cycle) {
  double sum = 0;
  for (const int side : cycle)
    sum += cross(g.points[start_of(g.lines, side)], g.points[start_of(g.lines, side ^ 1)]) / 2;
  return sum;
}

/// Whether a cycle goes around x, which is on no line: counterclockwise 1, clockwise -1.
int turns(const Lines& g, const Arrangement::Cycle& cycle, Vec2 x) {
  int turns = 0;
  for (const int side : cycle) {
    const Vec2 a = g.points[start_of(g.lines, side)];
    const Vec2 b = g.points[start_of(g.lines, side ^ 1)];
    if (a.y <= x.y && b.y > x.y && orient2d(a, b, x) > 0) ++turns;
    if (b.y <= x.y && a.y > x.y && orient2d(a, b, x) < 0) --turns;
  }
  return turns;
}

int components(const Lines& g) {
  std::vector<int> root(g.points.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int v) {
    while (root[v] != v) v = root[v];
    return v;
  };
  int joined = 0;
  for (const auto& [a, b] : g.lines) {
    const int i = find(a), j = find(b);
    joined += i != j;
    root[i] = j;
  }
  return static_cast<int>(g.points.size()) - joined;
}

TEST(Arrangement, FacesOfRandomLines) {
  std::mt19937 engine(11);
  int nested = 0, dangling = 0;
  for (int round = 0; round < 2000; ++round) {
    const Lines g = random_lines(engine, 4 + round % 20, 3 + round % 60);
    if (g.lines.empty()) continue;
    const Arrangement a = arrange(g.points, g.lines);
    ASSERT_FALSE(a.conflict) << round;
    // Euler: single points are components, too.
    ASSERT_EQ(static_cast<int>(g.points.size() - g.lines.size() + a.faces.size()), components(g)) << round;
    double inside = 0, outside = 0;
    std::set<int> sides;
    for (std::size_t f = 0; f < a.faces.size(); ++f) {
      const auto& cycles = a.faces[f].cycles;
      ASSERT_GT(area(g, cycles[0]), 0);
      nested += cycles.size() > 1;
      for (std::size_t c = 0; c < cycles.size(); ++c) {
        inside += area(g, cycles[c]);
        for (const int side : cycles[c]) {
          ASSERT_TRUE(sides.insert(side).second);
          ASSERT_EQ(a.face_of[side], static_cast<int>(f));
          // A place just left of the side is inside of the outline, and in nothing that lies in it.
          const Vec2 p = g.points[start_of(g.lines, side)];
          const Vec2 q = g.points[start_of(g.lines, side ^ 1)];
          const Vec2 x = 0.5 * (p + q) + 1e-3 * perp(q - p);
          int sum = 0;
          for (const auto& cycle : cycles) sum += turns(g, cycle, x);
          ASSERT_EQ(sum, 1) << round;
          ASSERT_EQ(turns(g, cycles[0], x), 1) << round;
        }
      }
      if (a.faces[f].around >= 0) {
        EXPECT_LT(a.faces[f].around, static_cast<int>(f));
      }
    }
    for (const auto& cycle : a.outside) {
      outside += area(g, cycle);
      for (const int side : cycle) ASSERT_TRUE(sides.insert(side).second);
    }
    for (std::size_t l = 0; l < g.lines.size(); ++l) dangling += a.has_one_face(static_cast<int>(l));
    ASSERT_EQ(sides.size(), 2 * g.lines.size());
    ASSERT_NEAR(inside, -outside, 1e-9) << round;
  }
  EXPECT_GT(nested, 10);
  EXPECT_GT(dangling, 1000);
}

TEST(Arrangement, FindsLinesThatMeet) {
  std::mt19937 engine(12);
  std::uniform_int_distribution<int> coordinate(0, 6);
  int conflicting = 0;
  for (int round = 0; round < 4000; ++round) {
    Lines g;
    std::set<std::pair<int, int>> taken;
    while (g.points.size() < 6) {
      const int x = coordinate(engine), y = coordinate(engine);
      if (taken.insert({x, y}).second) g.points.push_back({double(x), double(y)});
    }
    g.lines = {{0, 1}, {2, 3}, {round % 2 ? 0 : 4, 5}};
    bool expected = false;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < i; ++j) expected = expected || meet(g, g.lines[i], g.lines[j]);
    conflicting += expected;
    ASSERT_EQ(arrange(g.points, g.lines).conflict.has_value(), expected) << round;
  }
  EXPECT_GT(conflicting, 500);
}

}  // namespace
}  // namespace delquad
