// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/planar/arrangement.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

using Loops = std::vector<std::vector<int>>;

struct Polygons {
  std::vector<Vec2> points;
  Loops loops;
  void add(const std::vector<Vec2>& corners) {
    loops.emplace_back();
    for (Vec2 p : corners) {
      loops.back().push_back(static_cast<int>(points.size()));
      points.push_back(p);
    }
  }
};

/// How polygons lie in each other, by what their lines enclose.
struct LoopNesting {
  std::vector<int> parent;                          ///< of each the innermost one around it; -1: none
  std::optional<std::array<int, 4>> conflict = {};  ///< loop and line of two lines that meet
};

LoopNesting nest(const Polygons& p) {
  std::vector<std::array<int, 2>> lines, place;  // of each line: loop, and which of its lines
  for (std::size_t l = 0; l < p.loops.size(); ++l)
    for (std::size_t k = 0; k < p.loops[l].size(); ++k) {
      lines.push_back({p.loops[l][k], p.loops[l][(k + 1) % p.loops[l].size()]});
      place.push_back({static_cast<int>(l), static_cast<int>(k)});
    }
  const auto loop_of = [&](const Arrangement::Face& face) { return place[face.cycles[0][0] / 2][0]; };
  const Arrangement arrangement = arrange(p.points, lines);
  LoopNesting nesting{std::vector<int>(p.loops.size(), -1)};
  if (arrangement.conflict) {
    const auto [a, b] = *arrangement.conflict;
    nesting.conflict = {{place[a][0], place[a][1], place[b][0], place[b][1]}};
  }
  for (const Arrangement::Face& face : arrangement.faces)
    if (face.around >= 0) nesting.parent[loop_of(face)] = loop_of(arrangement.faces[face.around]);
  return nesting;
}

Vec2 at(const Polygons& p, std::size_t loop, std::size_t k) {
  const auto& nodes = p.loops[loop];
  return p.points[nodes[k % nodes.size()]];
}

bool on_segment(Vec2 a, Vec2 b, Vec2 p) {
  return orient2d(a, b, p) == 0 && std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) &&
         std::min(a.y, b.y) <= p.y && p.y <= std::max(a.y, b.y);
}

bool segments_meet(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  if (on_segment(a, b, c) || on_segment(a, b, d) || on_segment(c, d, a) || on_segment(c, d, b)) return true;
  return orient2d(a, b, c) * orient2d(a, b, d) < 0 && orient2d(c, d, a) * orient2d(c, d, b) < 0;
}

bool lines_conflict(const Polygons& p, std::size_t i, std::size_t k, std::size_t j, std::size_t m) {
  const Vec2 a = at(p, i, k), b = at(p, i, k + 1), c = at(p, j, m), d = at(p, j, m + 1);
  if (b == c) return on_segment(a, b, d) || on_segment(c, d, a);
  if (a == d) return on_segment(a, b, c) || on_segment(c, d, b);
  return segments_meet(a, b, c, d);
}

std::set<std::array<int, 4>> all_conflicts(const Polygons& p) {
  std::set<std::array<int, 4>> found;
  for (std::size_t i = 0; i < p.loops.size(); ++i)
    for (std::size_t k = 0; k < p.loops[i].size(); ++k)
      for (std::size_t j = 0; j < p.loops.size(); ++j)
        for (std::size_t m = 0; m < p.loops[j].size(); ++m)
          if (std::pair(i, k) < std::pair(j, m) && lines_conflict(p, i, k, j, m))
            found.insert(
                {static_cast<int>(i), static_cast<int>(k), static_cast<int>(j), static_cast<int>(m)});
  return found;
}

bool inside(const Polygons& p, std::size_t loop, Vec2 x) {
  bool odd = false;
  for (std::size_t k = 0; k < p.loops[loop].size(); ++k) {
    Vec2 a = at(p, loop, k), b = at(p, loop, k + 1);
    if (a.y > b.y) std::swap(a, b);
    if (a.y <= x.y && x.y < b.y && orient2d(a, b, x) > 0) odd = !odd;
  }
  return odd;
}

std::vector<int> brute_force_parents(const Polygons& p) {
  const auto contains = [&](std::size_t i, std::size_t j) { return i != j && inside(p, i, at(p, j, 0)); };
  std::vector<int> parent(p.loops.size(), -1);
  for (std::size_t j = 0; j < p.loops.size(); ++j) {
    std::size_t most = 0;
    for (std::size_t i = 0; i < p.loops.size(); ++i) {
      if (!contains(i, j)) continue;
      std::size_t depth = 1;
      for (std::size_t k = 0; k < p.loops.size(); ++k) depth += contains(k, i);
      if (depth > most) most = depth, parent[j] = static_cast<int>(i);
    }
  }
  return parent;
}

void make_counterclockwise(Polygons& p) {
  for (auto& nodes : p.loops) {
    double area = 0;
    for (std::size_t k = 0; k < nodes.size(); ++k)
      area += cross(p.points[nodes[k]], p.points[nodes[(k + 1) % nodes.size()]]);
    if (area < 0) std::reverse(nodes.begin(), nodes.end());
  }
}

// On a coarse grid nearly everything is degenerate: collinear, vertical, touching.
Polygons random_triangles(std::mt19937& engine, int count, int grid) {
  std::uniform_int_distribution<int> coordinate(0, grid);
  Polygons p;
  std::set<std::pair<int, int>> taken;
  while (static_cast<int>(p.loops.size()) < count) {
    std::vector<Vec2> corners;
    while (corners.size() < 3) {
      const int x = coordinate(engine), y = coordinate(engine);
      if (taken.insert({x, y}).second) corners.push_back({double(x), double(y)});
    }
    if (orient2d(corners[0], corners[1], corners[2]) != 0) p.add(corners);
  }
  make_counterclockwise(p);
  return p;
}

TEST(NestLoops, AgreesWithBruteForceOnRandomTriangles) {
  std::mt19937 engine(5);
  int sound = 0, conflicting = 0;
  for (int round = 0; round < 6000; ++round) {
    const Polygons p = random_triangles(engine, 1 + round % 5, round % 2 ? 6 + round % 7 : 60);
    const LoopNesting nesting = nest(p);
    const auto conflicts = all_conflicts(p);
    if (conflicts.empty()) {
      ++sound;
      ASSERT_FALSE(nesting.conflict) << round;
      ASSERT_EQ(nesting.parent, brute_force_parents(p)) << round;
    } else {
      ++conflicting;
      ASSERT_TRUE(nesting.conflict) << round;
      ASSERT_TRUE(conflicts.contains(*nesting.conflict)) << round;
    }
  }
  EXPECT_GT(sound, 500);
  EXPECT_GT(conflicting, 500);
}

TEST(NestLoops, FindsFoldsOfOneLoop) {
  std::mt19937 engine(6);
  int sound = 0, conflicting = 0;
  for (int round = 0; round < 4000; ++round) {
    std::uniform_int_distribution<int> coordinate(0, 7);
    std::set<std::pair<int, int>> taken;
    std::vector<Vec2> corners;
    while (corners.size() < 3u + static_cast<unsigned>(round % 4)) {
      const int x = coordinate(engine), y = coordinate(engine);
      if (taken.insert({x, y}).second) corners.push_back({double(x), double(y)});
    }
    Polygons p;
    p.add(corners);
    make_counterclockwise(p);
    const bool expected = !all_conflicts(p).empty();
    ASSERT_EQ(nest(p).conflict.has_value(), expected) << round;
    ++(expected ? conflicting : sound);
  }
  EXPECT_GT(sound, 500);
  EXPECT_GT(conflicting, 500);
}

std::vector<Vec2> comb(int teeth, double slant) {
  std::vector<Vec2> corners;
  for (int i = 0; i < teeth; ++i) {
    corners.push_back({2.0 * i, 0});
    corners.push_back({2.0 * i + 1 + slant, 1000});
  }
  corners.push_back({2.0 * teeth, 0});
  corners.push_back({1.0 * teeth, -10});
  return corners;
}

TEST(NestLoops, IsFastWhateverTheShape) {
  // Long slanted teeth overlap in any direction of the axes; the circle is the ordinary case.
  std::vector<Vec2> circle;
  for (int i = 0; i < 100000; ++i) {
    const double t = 2 * std::numbers::pi * i / 100000;
    circle.push_back({std::cos(t), std::sin(t)});
  }
  for (const std::vector<Vec2>& corners : {circle, comb(50000, 30000.0)}) {
    Polygons p;
    p.add(corners);
    make_counterclockwise(p);
    const auto start = std::chrono::steady_clock::now();
    EXPECT_FALSE(nest(p).conflict);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    RecordProperty("seconds", std::to_string(seconds));
    EXPECT_LT(seconds, 20);  // quadratic time would be minutes; sanitised builds are slow
  }
}

}  // namespace
}  // namespace delquad
