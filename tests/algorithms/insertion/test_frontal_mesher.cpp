#include "algorithms/insertion/frontal_mesher.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "base/context.h"
#include "geometry/mesh/constrained_delaunay.h"
#include "tests/algorithms/expect_resolved.h"
#include "tests/support/analytic_fields.h"
#include "tests/support/shapes.h"

namespace delquad {
namespace {

using testing_support::FunctionCross;
using testing_support::FunctionSize;
constexpr double kDegree = std::numbers::pi / 180;

std::vector<std::unique_ptr<PointPlacement>> strategies() {
  std::vector<std::unique_ptr<PointPlacement>> all;
  all.push_back(make_l2_frontal());
  all.push_back(make_linf_delquad());
  return all;
}

TEST(FrontalMesher, DelquadFillsARotatedSquareWithItsLattice) {
  for (const double degrees : {0.0, 20.0, 37.0, 45.0, 89.0}) {
    const auto boundary = shapes::rectangle(1, 1, 20, 20, degrees * kDegree);
    const TriPatch tri =
        mesh_frontal(boundary, *make_linf_delquad(), FunctionCross(degrees * kDegree), FunctionSize(0.05));
    EXPECT_EQ(tri.triangles.size(), 800u) << degrees;
    for (const Vec2 p : tri.points) {
      const double c = std::cos(degrees * kDegree), s = std::sin(degrees * kDegree);
      const double i = (c * p.x + s * p.y) * 20, j = (c * p.y - s * p.x) * 20;
      EXPECT_NEAR(i, std::round(i), 1e-11);
      EXPECT_NEAR(j, std::round(j), 1e-11);
    }
  }
}

TEST(FrontalMesher, VertexRatioOfTheNormsIsTwoOverRootThree) {
  const auto boundary = shapes::rectangle(1, 1, 150, 150);
  const FunctionSize size(1.0 / 150);
  const double f = mesh_frontal(boundary, *make_l2_frontal(), FunctionCross(0), size).points.size();
  const double d = mesh_frontal(boundary, *make_linf_delquad(), FunctionCross(0), size).points.size();
  EXPECT_NEAR(f / d / (2 / std::numbers::sqrt3), 1, 0.03);
}

TEST(FrontalMesher, RandomPolygonsWithHolesStayValidAndKeepTheirDistances) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    const auto boundary = shapes::random_polygon_with_holes(seed, 0.07);
    const FunctionSize size([](Vec2 u) { return 0.05 + 0.04 * std::sin(5 * u.x) * std::cos(4 * u.y); });
    const FunctionCross field([](Vec2 u) { return u.x - 2 * u.y; });
    for (const auto& strategy : strategies()) {
      FrontalSummary summary;
      const FrontalOptions options;
      const TriPatch tri = mesh_frontal(boundary, *strategy, field, size, options, &summary);
      SCOPED_TRACE(std::to_string(seed) + strategy->name());
      expect_resolved(tri, boundary, size, options, summary);
    }
  }
}

TEST(FrontalMesher, ResolvesAlmostEverything) {
  const auto boundary = shapes::plate_with_holes(2, 100, 4, 0.14, 44);
  for (const auto& strategy : strategies()) {
    FrontalSummary summary;
    const TriPatch tri =
        mesh_frontal(boundary, *strategy, FunctionCross(0.2), FunctionSize(0.02), {}, &summary);
    EXPECT_LT(summary.unresolved, 0.02 * tri.triangles.size()) << strategy->name();
  }
}

// All boundary edges are as long as the coarse size; only triangles inside can see the source.
TEST(FrontalMesher, FindsASmallSizeInsideACoarseBoundary) {
  const FunctionSize size([](Vec2 u) { return std::min(0.5, 0.01 + 0.5 * norm(u - Vec2{0.31, 0.29})); });
  const TriPatch tri =
      mesh_frontal(shapes::rectangle(1, 1, 2, 2), *make_linf_delquad(), FunctionCross(0), size);
  double nearest = INFINITY;
  for (const Vec2 p : tri.points) nearest = std::min(nearest, norm(p - Vec2{0.31, 0.29}));
  EXPECT_LT(nearest, 0.02);
}

TEST(FrontalMesher, SameBytesTwice) {
  const auto boundary = shapes::random_polygon_with_holes(7, 0.03);
  for (const auto& strategy : strategies()) {
    const auto once = mesh_frontal(boundary, *strategy, FunctionCross(0.3), FunctionSize(0.03));
    const auto twice = mesh_frontal(boundary, *strategy, FunctionCross(0.3), FunctionSize(0.03));
    ASSERT_EQ(once.points, twice.points);
    ASSERT_EQ(once.triangles, twice.triangles);
  }
}

// With many places that only the second look at resolved triangles finds, in several blocks of them.
TEST(FrontalMesher, IsTheSameBytesOnAnyNumberOfThreads) {
  constexpr double kStep = 0.17;
  const FunctionSize size([](Vec2 u) {
    const Vec2 off{std::remainder(u.x - 0.031, kStep), std::remainder(u.y - 0.029, kStep)};
    return std::min(0.01, 0.001 + 0.5 * norm(off));
  });
  const auto boundary = shapes::rectangle(1, 1, 100, 100);
  const auto without = mesh_frontal(boundary, *make_linf_delquad(), FunctionCross(0.3), FunctionSize(0.01));
  std::vector<TriPatch> results;
  for (const int threads : {1, 2, 3, 7}) {
    const RunScope run({.threads = threads});
    results.push_back(mesh_frontal(boundary, *make_linf_delquad(), FunctionCross(0.3), size));
  }
  ASSERT_GT(results[0].triangles.size(), without.triangles.size() + 2000);
  for (const TriPatch& other : results) {
    EXPECT_EQ(other.points, results[0].points);
    EXPECT_EQ(other.triangles, results[0].triangles);
  }
}

// Powers of two scale and shift without rounding, so that the mesh follows exactly.
TEST(FrontalMesher, ScalesWithItsInput) {
  auto boundary = shapes::plate_with_holes(1, 16, 2, 0.125, 12);
  const auto base = mesh_frontal(boundary, *make_linf_delquad(), FunctionCross(0.1), FunctionSize(0.0625));
  for (Vec2& p : boundary.points) p = 8.0 * p;
  const auto scaled = mesh_frontal(boundary, *make_linf_delquad(), FunctionCross(0.1), FunctionSize(0.5));
  ASSERT_EQ(base.triangles, scaled.triangles);
  for (size_t i = 0; i < base.points.size(); ++i) EXPECT_EQ(scaled.points[i], 8.0 * base.points[i]);
}

TEST(FrontalMesher, StopsAtMaxPointsAndSaysSo) {
  FrontalSummary summary;
  mesh_frontal(shapes::rectangle(1, 1, 50, 50), *make_linf_delquad(), FunctionCross(0), FunctionSize(0.02),
               {.max_points = 10}, &summary);
  EXPECT_EQ(summary.termination, FrontalTermination::kMaxPoints);
  EXPECT_EQ(summary.inserted, 10);
}

TEST(FrontalMesher, SliverDomainsEnd) {
  for (const double height : {1e-3, 1e-6, 1e-9}) {
    for (const auto& strategy : strategies()) {
      const auto tri =
          mesh_frontal(shapes::rectangle(1, height, 10, 1), *strategy, FunctionCross(0), FunctionSize(0.1));
      EXPECT_TRUE(check_invariants(tri).empty());
    }
  }
  const auto spike = mesh_frontal(shapes::polygon({{0, 0}, {1, 0}, {1, 0.01}}, 4), *make_linf_delquad(),
                                  FunctionCross(0), FunctionSize(0.002));
  EXPECT_TRUE(check_invariants(spike).empty());
}

}  // namespace
}  // namespace delquad
