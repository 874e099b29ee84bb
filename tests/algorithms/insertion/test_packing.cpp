#include "algorithms/insertion/frontal_mesher.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geometry/mesh/constrained_delaunay.h"
#include "tests/algorithms/expect_resolved.h"
#include "tests/support/analytic_fields.h"
#include "tests/support/shapes.h"

namespace delquad {
namespace {

using testing_support::FunctionCross;
using testing_support::FunctionSize;
constexpr double kPerDegree = std::numbers::pi / 180;

TriPatch pack(const PatchBoundary& boundary, const CrossField& cross, const ParametricSize& size,
              const FrontalOptions& options = {}, FrontalSummary* summary = nullptr) {
  return mesh_packing(boundary, *make_linf_delquad(), cross, size, options, summary);
}

TEST(Packing, FillsARotatedSquareWithItsLattice) {
  for (const double degrees : {0.0, 20.0, 37.0, 45.0, 89.0}) {
    const double c = std::cos(degrees * kPerDegree), s = std::sin(degrees * kPerDegree);
    FrontalSummary summary;
    const TriPatch tri = pack(shapes::rectangle(1, 1, 20, 20, degrees * kPerDegree),
                              FunctionCross(degrees * kPerDegree), FunctionSize(0.05), {}, &summary);
    EXPECT_EQ(tri.triangles.size(), 800u) << degrees;
    EXPECT_EQ(summary.packed, 19 * 19);
    EXPECT_EQ(summary.inserted, summary.packed);
    for (const Vec2 p : tri.points) {
      const double i = (c * p.x + s * p.y) * 20, j = (c * p.y - s * p.x) * 20;
      EXPECT_NEAR(i, std::round(i), 1e-11);
      EXPECT_NEAR(j, std::round(j), 1e-11);
    }
  }
}

// The grid w -> exp(w) of squares in the plane of w: sizes grow with the radius, the cross is polar. Each
// step is wrong by the third power of its length only.
TEST(Packing, FollowsAConformalGrid) {
  constexpr int kAround = 40, kOut = 20;
  const double step = 1.0 / kAround;
  const auto grid = [&](double i, double j) {
    return std::exp(i * step) * Vec2{std::cos(j * step), std::sin(j * step)};
  };
  std::vector<Vec2> corners;
  for (int i = 0; i < kOut; ++i) corners.push_back(grid(i, 0));
  for (int j = 0; j < kAround; ++j) corners.push_back(grid(kOut, j));
  for (int i = kOut; i > 0; --i) corners.push_back(grid(i, kAround));
  for (int j = kAround; j > 0; --j) corners.push_back(grid(0, j));
  FrontalSummary summary;
  const TriPatch tri =
      pack(shapes::polygon(corners, 1), FunctionCross([](Vec2 u) { return std::atan2(u.y, u.x); }),
           FunctionSize([&](Vec2 u) { return step * norm(u); }), {}, &summary);
  EXPECT_EQ(summary.packed, (kOut - 1) * (kAround - 1));
  EXPECT_EQ(tri.triangles.size(), 2u * kOut * kAround);
  for (const Vec2 p : tri.points) {
    const double i = std::log(norm(p)) / step, j = std::atan2(p.y, p.x) / step;
    EXPECT_NEAR(i, std::round(i), 0.01);
    EXPECT_NEAR(j, std::round(j), 0.01);
  }
}

TEST(Packing, RandomPolygonsWithHolesStayValidAndKeepTheirDistances) {
  const FunctionSize size([](Vec2 u) { return 0.05 + 0.04 * std::sin(5 * u.x) * std::cos(4 * u.y); });
  const FunctionCross field([](Vec2 u) { return u.x - 2 * u.y; });
  const FrontalOptions options;
  for (unsigned seed = 0; seed < 60; ++seed) {
    const auto boundary = shapes::random_polygon_with_holes(seed, 0.07);
    FrontalSummary summary;
    const TriPatch tri = pack(boundary, field, size, options, &summary);
    SCOPED_TRACE(seed);
    expect_resolved(tri, boundary, size, options, summary);
    ASSERT_LE(summary.packed, summary.inserted);
  }
}

// Where packing cannot begin, the filler has to do it all.
TEST(Packing, TheFillerFindsASmallSizeInsideACoarseBoundary) {
  const FunctionSize size([](Vec2 u) { return std::min(0.5, 0.01 + 0.5 * norm(u - Vec2{0.31, 0.29})); });
  FrontalSummary summary;
  const TriPatch tri = pack(shapes::rectangle(1, 1, 2, 2), FunctionCross(0), size, {}, &summary);
  EXPECT_LT(summary.packed, summary.inserted);
  double nearest = INFINITY;
  for (const Vec2 p : tri.points) nearest = std::min(nearest, norm(p - Vec2{0.31, 0.29}));
  EXPECT_LT(nearest, 0.02);
}

TEST(Packing, LeavesFewTrianglesUnresolved) {
  FrontalSummary summary;
  const TriPatch tri = pack(shapes::plate_with_holes(2, 100, 4, 0.14, 44), FunctionCross(0.2),
                            FunctionSize(0.02), {}, &summary);
  EXPECT_LT(summary.unresolved, 0.02 * tri.triangles.size());
}

TEST(Packing, SameBytesTwice) {
  const auto boundary = shapes::random_polygon_with_holes(7, 0.03);
  const auto once = pack(boundary, FunctionCross(0.3), FunctionSize(0.03));
  const auto twice = pack(boundary, FunctionCross(0.3), FunctionSize(0.03));
  ASSERT_EQ(once.points, twice.points);
  ASSERT_EQ(once.triangles, twice.triangles);
}

// Powers of two scale without rounding, so that the mesh follows exactly.
TEST(Packing, ScalesWithItsInput) {
  auto boundary = shapes::plate_with_holes(1, 16, 2, 0.125, 12);
  const auto base = pack(boundary, FunctionCross(0.1), FunctionSize(0.0625));
  for (Vec2& p : boundary.points) p = 8.0 * p;
  const auto scaled = pack(boundary, FunctionCross(0.1), FunctionSize(0.5));
  ASSERT_EQ(base.triangles, scaled.triangles);
  for (size_t i = 0; i < base.points.size(); ++i) EXPECT_EQ(scaled.points[i], 8.0 * base.points[i]);
}

TEST(Packing, StopsAtMaxPointsAndSaysSo) {
  FrontalSummary summary;
  pack(shapes::rectangle(1, 1, 50, 50), FunctionCross(0), FunctionSize(0.02), {.max_points = 10}, &summary);
  EXPECT_EQ(summary.termination, FrontalTermination::kMaxPoints);
  EXPECT_EQ(summary.inserted, 10);
}

// Sizes such as sqrt(1 - r^2) exist inside only. Points of the boundary may be outside by rounding.
TEST(Packing, AsksNoFieldOutsideTheDomain) {
  const auto inside = [](Vec2 u) {
    const double r = norm(u);
    return r < 1 + 1e-12 && r > 0.3 * std::cos(std::numbers::pi / 30) - 1e-12;
  };
  const FunctionSize size([&](Vec2 u) {
    EXPECT_TRUE(inside(u)) << u.x << ", " << u.y;
    return 0.05 + 0.05 * norm(u);
  });
  const FunctionCross cross([&](Vec2 u) {
    EXPECT_TRUE(inside(u)) << u.x << ", " << u.y;
    return std::atan2(u.y, u.x) + 0.2;
  });
  const TriPatch tri = pack(shapes::annulus(0.3, 1, 30, 70), cross, size);
  EXPECT_GT(tri.points.size(), 400u);
}

TEST(Packing, SliverDomainsEnd) {
  for (const double height : {1e-3, 1e-6, 1e-9}) {
    EXPECT_TRUE(
        check_invariants(pack(shapes::rectangle(1, height, 10, 1), FunctionCross(0), FunctionSize(0.1)))
            .empty());
  }
  const auto spike =
      pack(shapes::polygon({{0, 0}, {1, 0}, {1, 0.01}}, 4), FunctionCross(0), FunctionSize(0.002));
  EXPECT_TRUE(check_invariants(spike).empty());
}

TEST(FillFrontal, StartsFromWhatIsThere) {
  const auto boundary = shapes::rectangle(1, 1, 10, 10);
  const TriPatch start = constrained_delaunay(boundary, {{0.31, 0.42}});
  FrontalSummary summary;
  const TriPatch tri =
      fill_frontal(start, *make_linf_delquad(), FunctionCross(0), FunctionSize(0.1), {}, &summary);
  EXPECT_TRUE(check_invariants(tri).empty());
  EXPECT_EQ(tri.n_boundary, start.n_boundary);
  EXPECT_TRUE(std::equal(start.points.begin(), start.points.end(), tri.points.begin()));
  EXPECT_EQ(start.points.size() + summary.inserted, tri.points.size());
  EXPECT_GT(summary.inserted, 50);
}

}  // namespace
}  // namespace delquad
