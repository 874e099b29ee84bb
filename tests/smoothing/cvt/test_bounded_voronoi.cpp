// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/cvt/bounded_voronoi.h"
#include "smoothing/cvt/cell_walk.h"
#include "tests/smoothing/seeds.h"

namespace delquad {
namespace {

bool is_inside(const PatchBoundary& boundary, Vec2 p) {
  bool inside = false;
  for (const auto& [i, j] : boundary.edges) {
    const Vec2 a = boundary.points[i], b = boundary.points[j];
    if ((a.y > p.y) != (b.y > p.y) && (orient2d(a, b, p) > 0) == (b.y > a.y)) inside = !inside;
  }
  return inside;
}

/// Whether the segment from a seed to p crosses the boundary; a seed on it is seen from inside.
bool is_hidden(const PatchBoundary& boundary, Vec2 seed, Vec2 p) {
  for (const auto& [i, j] : boundary.edges) {
    const Vec2 a = boundary.points[i], b = boundary.points[j];
    if (seed == a || seed == b) continue;
    if (orient2d(a, b, seed) != orient2d(a, b, p) && orient2d(seed, p, a) != orient2d(seed, p, b))
      return true;
  }
  // From a corner of the boundary into the outside.
  return !is_inside(boundary, seed + 1e-6 * (p - seed));
}

int nearest_visible(const PatchBoundary& boundary, const std::vector<Vec2>& points, Vec2 p) {
  int best = -1;
  for (std::size_t i = 0; i < points.size(); ++i)
    if ((best < 0 || norm(points[i] - p) < norm(points[best] - p)) && !is_hidden(boundary, points[i], p))
      best = static_cast<int>(i);
  return best;
}

/// The triangles that make up the cells, by seed.
std::vector<std::vector<std::array<Vec2, 2>>> all_cells(const MovingDelaunay& d,
                                                        const BoundedVoronoi& cells) {
  std::vector<std::vector<std::array<Vec2, 2>>> result(d.n_points());
  for (int i = 0; i < d.n_points(); ++i)
    walk_cell(d, cells, i, [&](const CellEnd& a, const CellEnd& b) { result[i].push_back({a.at, b.at}); });
  for (const auto& piece : cells.pieces())
    result[piece.seed].push_back({cells.clips()[piece.from].at, cells.clips()[piece.to].at});
  return result;
}

/// Sample points lie in the cell of the nearest seed that they see, and in no other; areas add up.
int check_cells(const PatchBoundary& boundary, const std::vector<Vec2>& seeds, std::uint64_t random_seed) {
  const MovingDelaunay d(constrained_delaunay(boundary, seeds));
  BoundedVoronoi voronoi;
  EXPECT_TRUE(voronoi.build(d));
  const auto cells = all_cells(d, voronoi);
  const std::vector<Vec2>& points = d.patch().points;
  double area = 0, expected = 0;
  for (int i = 0; i < d.n_points(); ++i)
    for (const auto& [a, b] : cells[i]) area += cross(a - points[i], b - points[i]) / 2;
  for (const auto& [i, j] : boundary.edges) expected += cross(boundary.points[i], boundary.points[j]) / 2;
  EXPECT_NEAR(area, expected, 1e-10 * expected);

  std::mt19937_64 random(1000 + random_seed);  // not the one that made the seeds
  int samples = 0;
  while (samples < 500) {
    const Vec2 p{2 * shapes::uniform(random) - 1, 2 * shapes::uniform(random) - 1};
    if (!is_inside(boundary, p)) continue;
    ++samples;
    const int owner = nearest_visible(boundary, points, p);
    for (int i = 0; i < d.n_points(); ++i) {
      double covered = 0;  // signed, so that overlaps of a star-shaped cell's triangles cancel
      for (const auto& [a, b] : cells[i]) {
        const double turn = cross(a - points[i], b - points[i]);
        const double s = cross(a - points[i], p - points[i]), t = cross(p - points[i], b - points[i]);
        if (turn > 0 && s >= 0 && t > 0 && s + t <= turn) ++covered;
        if (turn < 0 && s <= 0 && t < 0 && s + t >= turn) --covered;
      }
      EXPECT_EQ(covered, i == owner ? 1 : 0)
          << "seed " << i << " at " << points[i].x << " " << points[i].y << ", sample " << p.x << " " << p.y
          << ", domain " << random_seed;
    }
  }
  return static_cast<int>(voronoi.clips().size());
}

TEST(BoundedVoronois, CellsAreWhatTheirSeedsSeeNearest) {
  int clips = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const PatchBoundary boundary = shapes::random_polygon_with_holes(seed, seed % 3 == 0 ? 0.15 : 0);
    clips += check_cells(boundary, random_seeds(boundary, seed, 60, 0.01), seed);
  }
  EXPECT_GT(clips, 300);  // boundary edges were crossed
}

TEST(BoundedVoronois, SeeNothingThroughThinWalls) {
  // Two boxes, 1e-4 apart, joined at the right; seeds near the wall on both sides.
  const PatchBoundary boundary = shapes::polygon(
      {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, 1e-4}, {0.5, 1e-4}, {0.5, -1e-4}, {-1, -1e-4}});
  EXPECT_GT(check_cells(boundary, {{-0.5, 0.01}, {-0.4, -0.02}, {0.1, 0.1}, {0.2, 0.02}, {0.3, -0.01}}, 1),
            4);
}

TEST(BoundedVoronois, NarrowNecksAreKept) {
  // Two squares joined by a channel of width 1e-6.
  const PatchBoundary boundary = shapes::polygon({{-1, -1},
                                                  {-0.1, -1},
                                                  {-0.1, 0},
                                                  {0.1, 0},
                                                  {0.1, -1},
                                                  {1, -1},
                                                  {1, 1},
                                                  {0.1, 1},
                                                  {0.1, 1e-6},
                                                  {-0.1, 1e-6},
                                                  {-0.1, 1},
                                                  {-1, 1}});
  check_cells(boundary, {{-0.5, 0.3}, {-0.2, 1e-7}, {0.3, 0.2}, {0.6, -0.6}}, 2);
}

TEST(BoundedVoronois, CellsOfALatticeAreSquares) {
  const int n = 8;
  std::vector<Vec2> seeds;
  for (int j = 1; j < n; ++j)
    for (int i = 1; i < n; ++i) seeds.push_back({double(i) / n, double(j) / n});
  const MovingDelaunay d(constrained_delaunay(shapes::rectangle(1, 1, n, n), seeds));
  BoundedVoronoi voronoi;
  ASSERT_TRUE(voronoi.build(d));
  EXPECT_TRUE(voronoi.clips().empty());
  for (int i = d.n_boundary(); i < d.n_points(); ++i) {
    double area = 0;
    walk_cell(d, voronoi, i, [&](const CellEnd& a, const CellEnd& b) {
      const Vec2 x = d.patch().points[i];
      area += cross(a.at - x, b.at - x) / 2;
      EXPECT_NEAR(norm(a.at - x), std::sqrt(0.5) / n, 1e-14);
    });
    EXPECT_NEAR(area, 1.0 / (n * n), 1e-14);
  }
}

}  // namespace
}  // namespace delquad
