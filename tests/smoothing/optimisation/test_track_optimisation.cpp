// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/quad_corners.h"
#include "smoothing/optimisation/track_optimisation.h"
#include "tests/support/meshing.h"
#include "tests/support/quad_patch_checks.h"
#include "tests/support/quad_patches.h"

namespace delquad {
namespace {

/// A quarter of a cylinder about the x axis, of radius 4; the grid's u is x, v the arc length. The boundary
/// vertices slide along the sides of the grid, its corners stay.
class CylinderTracks final : public VertexTracks<Vec3> {
 public:
  CylinderTracks(QuadPatch grid, double width, double height, double delta = 1)
      : grid_(std::move(grid)), width_(width), height_(height), delta_(delta) {}
  std::vector<Vec3> points() const {
    std::vector<Vec3> points;
    for (const Vec2 u : grid_.points) points.push_back(place(u));
    return points;
  }
  Vec2 position(int v) const override { return grid_.points[v]; }
  Vec3 put(int v, Vec2 position) override { return place(grid_.points[v] = position); }
  std::array<Vec3, 2> axes(int v) const override {
    const Vec2 u = grid_.points[v];
    std::array<Vec3, 2> axes{Vec3{1, 0, 0}, Vec3{0, -std::sin(u.y / kRadius), std::cos(u.y / kRadius)}};
    if (u.x == 0 || u.x == width_) axes[0] = {};
    if (u.y == 0 || u.y == height_) axes[1] = {};
    return axes;
  }
  double delta(const Vec3& /*place*/, TrackHint& /*hint*/) const override { return delta_; }
  Vec3 arm(int /*quad*/, int /*side*/, TrackHint& /*hint*/) const override { return {1, 0, 0}; }

  const QuadPatch& grid() const { return grid_; }

 private:
  static constexpr double kRadius = 4;
  static Vec3 place(Vec2 u) {
    return {u.x, kRadius * std::cos(u.y / kRadius), kRadius * std::sin(u.y / kRadius)};
  }
  QuadPatch grid_;
  double width_, height_, delta_;
};

double worst(const std::vector<Vec3>& points, const std::vector<std::array<int, 4>>& quads) {
  double least = 1;
  for (const auto& v : quads)
    for (const double sine : corner_sines(std::array{points[v[0]], points[v[1]], points[v[2]], points[v[3]]}))
      least = std::min(least, sine);
  return least;
}

/// The grid with its boundary vertices but the corners shifted along their sides.
QuadPatch shifted_boundary(QuadPatch grid, double width, double height) {
  for (int v = 0; v < grid.n_boundary; ++v) {
    Vec2& u = grid.points[v];
    const bool at_side = u.x == 0 || u.x == width, at_end = u.y == 0 || u.y == height;
    if (at_side && !at_end) u.y += 0.3;
    if (at_end && !at_side) u.x -= 0.3;
  }
  return grid;
}

TEST(TrackOptimisation, GridOnACylinderBecomesRegularAndStaysOnItsTracks) {
  const QuadPatch grid = grid_patch(7, 6);
  for (int seed = 0; seed < 5; ++seed) {
    CylinderTracks tracks(jittered(shifted_boundary(grid, 7, 6), seed, 0.25), 7, 6);
    std::vector<Vec3> points = tracks.points();
    const double before = worst(points, grid.quads);
    const OptimisationSummary summary = optimise_on_tracks(points, grid.quads, tracks);
    EXPECT_GT(summary.worst_after, summary.worst_before);
    EXPECT_GT(worst(points, grid.quads), std::max(before, 0.98));
    EXPECT_EQ(points, tracks.points());
    for (std::size_t v = 0; v < grid.points.size(); ++v) {
      const Vec2 u = tracks.grid().points[v];
      EXPECT_LT(norm(u - grid.points[v]), 0.1);
      if (grid.points[v].x == 0 || grid.points[v].x == 7) {
        EXPECT_EQ(u.x, grid.points[v].x);
      }
      if (grid.points[v].y == 0 || grid.points[v].y == 6) {
        EXPECT_EQ(u.y, grid.points[v].y);
      }
    }
  }
}

TEST(TrackOptimisation, NoQuadFallsBelowWhatItMustKeep) {
  const QuadPatch grid = grid_patch(6, 6);
  for (int seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    CylinderTracks tracks(jittered(grid, seed, 0.45), 6, 6);
    std::vector<Vec3> points = tracks.points();
    const double before = worst(points, grid.quads);
    optimise_on_tracks(points, grid.quads, tracks);
    EXPECT_GE(worst(points, grid.quads), std::min(before, std::sin(kOptimisedFloorEta * std::acos(0.0))));
  }
}

TEST(TrackOptimisation, EdgesKeepAFifthOfTheirLength) {
  const QuadPatch grid = grid_patch(6, 6);
  for (int seed = 0; seed < 20; ++seed) {
    // Wanted to be far shorter, edges would vanish.
    CylinderTracks tracks(jittered(grid, seed, 0.4), 6, 6, 0.01);
    std::vector<Vec3> points = tracks.points();
    const std::vector<Vec3> before = points;
    optimise_on_tracks(points, grid.quads, tracks, {.size = 50});
    for (const auto& quad : grid.quads)
      for (int k = 0; k < 4; ++k) {
        const int a = quad[k], b = quad[(k + 1) % 4];
        EXPECT_GE(norm(points[b] - points[a]), 0.2 * std::min(norm(before[b] - before[a]), 0.01));
      }
  }
}

TEST(TrackOptimisation, ThinQuadsGetNoThinner) {
  for (int seed = 0; seed < 20; ++seed) {
    QuadPatch grid = jittered(grid_patch(6, 6), seed, 0.4);
    for (Vec2& u : grid.points) u.x *= 6;
    CylinderTracks tracks(grid, 36, 6, 1);
    std::vector<Vec3> points = tracks.points();
    const auto least = [&] {
      QuadPatch now = tracks.grid();
      return least_room(now, FunctionSize(1));
    };
    const double before = least();
    optimise_on_tracks(points, grid.quads, tracks, {.size = 5});
    EXPECT_GE(least(), std::min(before, kShortSide)) << seed;
  }
}

TEST(TrackOptimisation, InvertedQuadsAreHeld) {
  QuadPatch grid = grid_patch(6, 6);
  const int turned = grid.n_boundary + 12;
  grid.points[turned] += Vec2{1.6, 0.1};
  CylinderTracks tracks(grid, 6, 6);
  std::vector<Vec3> points = tracks.points();
  const Vec3 place = points[turned];
  const OptimisationSummary summary = optimise_on_tracks(points, grid.quads, tracks);
  EXPECT_GT(summary.held, 0);
  EXPECT_EQ(points[turned], place);
}

}  // namespace
}  // namespace delquad
