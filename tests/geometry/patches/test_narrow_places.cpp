// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/patches/across_view.h"
#include "geometry/patches/face_corners.h"
#include "geometry/patches/narrow_places.h"
#include "geometry/surface/flatten.h"
#include "tests/support/meshing.h"
#include "tests/support/polygon_face.h"

namespace delquad {
namespace {

namespace surfaces = testing_support;

/// A model with all that the steps on curves need.
struct Narrow {
  explicit Narrow(SurfaceModel m, double h)
      : model(std::move(m)), on_lines([h](int, int, double, const Vec3&, int&) { return h; }) {
    maps = flatten(model).patches;
    chains = curve_chains(model);
    const LineIndex lines(chains);
    for (const FlatPatch& map : maps) outlines.push_back(lines.outline(map, chains, "face"));
    across.emplace(model.fine, chains, maps, outlines);
    for (const CurveChain& chain : chains) integrals.push_back(size_integral(model.fine, chain, on_lines));
  }

  /// The curve from one corner to another.
  int chain(Vec2 from, Vec2 to) const {
    for (size_t c = 0; c < chains.size(); ++c) {
      const Vec3 a = model.fine.points[chains[c].points.front()],
                 b = model.fine.points[chains[c].points.back()];
      if (norm(Vec2{a.x, a.y} - from) < 1e-9 && norm(Vec2{b.x, b.y} - to) < 1e-9) return static_cast<int>(c);
    }
    return -1;
  }

  SurfaceModel model;
  SizeOnLine on_lines;
  std::vector<FlatPatch> maps;
  std::vector<CurveChain> chains;
  std::vector<PatchOutline> outlines;
  std::optional<AcrossView> across;
  std::vector<SizeIntegral> integrals;
};

const std::vector<Vec2> kStrip = {{0, 0}, {10, 0}, {10, 0.4}, {0, 0.4}};

TEST(AcrossView, SeesTheOtherSideOfAStripStraightAcross) {
  const Narrow strip(surfaces::polygon_face(kStrip, 0.3), 1);
  const int bottom = strip.chain({0, 0}, {10, 0}), top = strip.chain({10, 0.4}, {0, 0.4});
  const double lines = static_cast<double>(strip.chains[bottom].points.size() - 1);
  const auto seen = strip.across->look(bottom, 0.31 * lines, 1);
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_EQ(seen[0].chain, top);
  EXPECT_NEAR(seen[0].distance, 0.4, 1e-9);
  EXPECT_NEAR(seen[0].s, 0.69 * static_cast<double>(strip.chains[top].points.size() - 1), 1e-6);
  EXPECT_TRUE(strip.across->look(bottom, 0.31 * lines, 0.39).empty());
}

TEST(AcrossView, GoesThroughALimitedNumberOfNeedles) {
  // Rows of two triangles each, as long as the strip.
  const auto seen_through = [](int rows) {
    Mesh fine;
    for (int r = 0; r <= rows; ++r) {
      for (const double x : {0., 10.}) fine.points.push_back({x, 1. * r / rows, 0});
      if (r > 0) fine.triangles.push_back({2 * r - 2, 2 * r - 1, 2 * r + 1});
      if (r > 0) fine.triangles.push_back({2 * r - 2, 2 * r + 1, 2 * r});
    }
    fine.triangle_region.assign(fine.triangles.size(), 0);
    fine.regions = {{1, {}}};
    const Narrow strip(make_surface_model(fine), 1);
    return strip.across->look(strip.chain({0, 0}, {10, 0}), 0.31, 2).size();
  };
  EXPECT_EQ(seen_through(300), 1u);
  EXPECT_EQ(seen_through(900), 0u);
}

TEST(AcrossView, CornersAreNotNarrowButCuspsAre) {
  const auto near_corner = [](double degrees) {
    const double a = degrees * std::numbers::pi / 180;
    const Narrow wedge(surfaces::polygon_face({{0, 0}, {5, 0}, {5 * std::cos(a), 5 * std::sin(a)}}, 0.2), 1);
    return wedge.across->look(wedge.chain({0, 0}, {5, 0}), 2.5, 1).size();
  };
  EXPECT_EQ(near_corner(45), 0u);
  EXPECT_EQ(near_corner(25), 0u);
  EXPECT_EQ(near_corner(5), 1u);
}

TEST(GroupFacingCurves, OnlySidesOfAStripBelongTogether) {
  const Narrow strip(surfaces::polygon_face(kStrip, 0.1), 1);
  const auto group = group_facing_curves(strip.model.fine, strip.chains, *strip.across, strip.on_lines);
  EXPECT_EQ(group[strip.chain({0, 0}, {10, 0})], group[strip.chain({10, 0.4}, {0, 0.4})]);
  EXPECT_NE(group[strip.chain({0, 0}, {10, 0})], group[strip.chain({10, 0}, {10, 0.4})]);
  const Narrow square(surfaces::polygon_face({{0, 0}, {5, 0}, {5, 5}, {0, 5}}, 0.5), 1);
  const auto alone = group_facing_curves(square.model.fine, square.chains, *square.across, square.on_lines);
  for (size_t c = 0; c < alone.size(); ++c) EXPECT_EQ(alone[c], static_cast<int>(c));
}

// The upper side alone asks for edges that grow along it: equal integrals are not opposite each other.
TEST(FaceNodes, NodesAcrossAStripLieOppositeEachOther) {
  Narrow strip(surfaces::polygon_face({{0, 0}, {10, 0}, {10, 0.2}, {0, 0.2}}, 0.1), 1);
  const int bottom = strip.chain({0, 0}, {10, 0}), top = strip.chain({10, 0.2}, {0, 0.2});
  strip.integrals[top] =
      size_integral(strip.model.fine, strip.chains[top],
                    [](int, int, double, const Vec3& x, int&) { return 0.6 + 0.08 * x.x; });
  std::vector<int> counts(strip.chains.size(), 1);
  counts[bottom] = counts[top] = 10;
  const auto x_of = [&](const CurvePlaces& places, int chain, int k) {
    const double s = strip.integrals[chain].s_at(places[chain][k] / 10);
    return (chain == bottom ? s : 100 - s) / 10;  // lines are 0.1 long
  };
  const auto shear = [&](const CurvePlaces& places) {
    double most = 0;
    for (int k = 0; k <= 10; ++k)
      most = std::max(most, std::abs(x_of(places, bottom, k) - x_of(places, top, 10 - k)));
    return most;
  };
  const auto face = [&](long long most_steps) {
    Budget steps(most_steps);
    return align_opposite_nodes(
        strip.model.fine, strip.chains, *strip.across, strip.integrals, counts,
        group_facing_curves(strip.model.fine, strip.chains, *strip.across, strip.on_lines), strip.on_lines,
        steps);
  };
  EXPECT_EQ(face(0), equal_places(counts));
  const CurvePlaces faced = face(1'000'000);
  EXPECT_GT(shear(equal_places(counts)), 0.5);
  EXPECT_LT(shear(faced), 0.05);
  for (const auto& places : faced)
    for (size_t k = 1; k < places.size(); ++k) EXPECT_GT(places[k], places[k - 1]);
}

PatchBoundary polygon(std::vector<Vec2> points) {
  PatchBoundary boundary;
  boundary.points = std::move(points);
  const int n = static_cast<int>(boundary.points.size());
  for (int i = 0; i < n; ++i) boundary.edges.push_back({i, (i + 1) % n});
  return boundary;
}

TEST(NarrowSeeds, TwoRowsLeadAwayFromASharpCorner) {
  PatchBoundary wedge =
      polygon({{0, 0}, {1, -0.05}, {2, -0.1}, {3, -0.15}, {3, 0}, {3, 0.15}, {2, 0.1}, {1, 0.05}});
  seed_narrow_places(wedge);
  ASSERT_EQ(wedge.seeds.size(), 2u);
  for (const Vec2 seed : wedge.seeds) EXPECT_NEAR(seed.y, 0, 1e-12);
}

TEST(NarrowSeeds, AStripOfSingleQuadsNeedsNone) {
  PatchBoundary strip = polygon({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 0.2}, {2, 0.2}, {1, 0.2}, {0, 0.2}});
  seed_narrow_places(strip);
  EXPECT_TRUE(strip.seeds.empty());
}

// Between two squares: the neck's nodes cut off either an even or an odd number of edges.
TEST(NarrowSeeds, ANeckIsSeededWhereItCutsOffAnOddNumberOfEdges) {
  const auto dumbbell = [](bool odd) {
    std::vector<Vec2> points = {{0, -1}, {1, -1}, {1, -0.1}, {2, -0.1}, {3, -0.1}, {3, -1}, {4, -1}, {4, 0},
                                {4, 1},  {3, 1},  {3, 0.1},  {2, 0.1},  {1, 0.1},  {1, 1},  {0, 1},  {0, 0}};
    // Takes a node from one square to the other.
    if (odd) points.erase(points.begin() + 7), points.insert(points.begin() + 1, {0.5, -1});
    return points;
  };
  PatchBoundary even = polygon(dumbbell(false)), odd = polygon(dumbbell(true)), whole = even;
  seed_narrow_places(whole, 0.5);
  EXPECT_TRUE(whole.seeds.empty());
  seed_narrow_places(even);
  seed_narrow_places(odd);
  // 4 edges of a square's outline, 2 to the neck, 1 across: odd.
  EXPECT_EQ(even.seeds.size(), 3u);
  EXPECT_TRUE(odd.seeds.empty());
}

TEST(FaceCorners, AnglesAreThoseInSpace) {
  const Narrow wedge(surfaces::polygon_face({{0, 0}, {5, 0}, {4, 3}}, 0.2), 1);
  const auto corners = face_corners(wedge.model.fine, wedge.chains, wedge.maps, wedge.outlines);
  ASSERT_EQ(corners.size(), 3u);
  double sum = 0, least = 10;
  for (const FaceCorner& c : corners) sum += c.angle, least = std::min(least, c.angle);
  EXPECT_NEAR(sum, std::numbers::pi, 1e-9);
  EXPECT_NEAR(least, std::atan2(3, 4), 1e-9);
}

TEST(FaceCorners, BoundsFollowFromTheAngleAndTheNumberOfQuads) {
  const auto bound = [](double degrees) { return corner_eta_bound(degrees * std::numbers::pi / 180); };
  EXPECT_NEAR(bound(3), 3.0 / 90, 1e-12);
  EXPECT_NEAR(bound(90), 1, 1e-12);
  EXPECT_NEAR(bound(180), 1, 1e-12);
  EXPECT_NEAR(bound(120), 2.0 / 3, 1e-12);  // one quad of 120 degrees or two of 60
  EXPECT_NEAR(bound(360), 1, 1e-12);
}

}  // namespace
}  // namespace delquad
