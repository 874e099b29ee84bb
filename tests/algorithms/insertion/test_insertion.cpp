// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/algorithms/stages.h"

namespace delquad {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

struct Inserter {
  const char* name;
  decltype(mesh_frontal)* mesh;
  std::unique_ptr<PointPlacement> (*placement)();
};

class Insertion : public testing::TestWithParam<Inserter> {
 protected:
  /// Checks what holds for any input.
  TriPatch insert(const PatchBoundary& boundary, const CrossField& cross, const ParametricSize& size,
                  const FrontalOptions& options = {}) {
    TriPatch tri = GetParam().mesh(boundary, *GetParam().placement(), cross, size, options, &summary_);
    EXPECT_TRUE(check_invariants(tri).empty());
    EXPECT_LE(summary_.packed, summary_.inserted);
    return tri;
  }
  FrontalSummary summary_;
};
class LinfInsertion : public Insertion {};

const auto kName = [](const auto& info) { return info.param.name; };
const Inserter kL2{"L2", mesh_frontal, make_l2_frontal}, kFrontal{"Linf", mesh_frontal, make_linf_delquad},
    kPacking{"Packing", mesh_packing, make_linf_delquad};
INSTANTIATE_TEST_SUITE_P(All, Insertion, testing::Values(kL2, kFrontal, kPacking), kName);
INSTANTIATE_TEST_SUITE_P(All, LinfInsertion, testing::Values(kFrontal, kPacking), kName);

TEST_P(LinfInsertion, FillsARotatedSquareWithItsLattice) {
  for (const double degrees : {0.0, 20.0, 37.0, 45.0, 89.0}) {
    const double c = std::cos(degrees * kDegree), s = std::sin(degrees * kDegree);
    const TriPatch tri = insert(shapes::rectangle(1, 1, 20, 20, degrees * kDegree),
                                FunctionCross(degrees * kDegree), FunctionSize(0.05));
    EXPECT_EQ(tri.triangles.size(), 800u) << degrees;
    EXPECT_EQ(summary_.inserted, 19 * 19);
    EXPECT_EQ(summary_.packed, GetParam().mesh == mesh_packing ? 19 * 19 : 0);
    for (const Vec2 p : tri.points) {
      const double i = (c * p.x + s * p.y) * 20, j = (c * p.y - s * p.x) * 20;
      EXPECT_NEAR(i, std::round(i), 1e-11);
      EXPECT_NEAR(j, std::round(j), 1e-11);
    }
  }
}

/// Edges to inserted points keep the rejection distance: the size varies by less than a third along an edge.
TEST_P(Insertion, RandomPolygonsWithHolesStayValidAndKeepTheirDistances) {
  const FunctionSize size([](Vec2 u) { return 0.05 + 0.04 * std::sin(5 * u.x) * std::cos(4 * u.y); });
  const FunctionCross field([](Vec2 u) { return u.x - 2 * u.y; });
  for (unsigned seed = 0; seed < 60; ++seed) {
    const auto boundary = shapes::random_polygon_with_holes(seed, 0.07);
    SCOPED_TRACE(seed);
    const TriPatch tri = insert(boundary, field, size);
    ASSERT_EQ(summary_.termination, FrontalTermination::kResolved);
    ASSERT_EQ(summary_.inserted + boundary.points.size(), tri.points.size());
    ASSERT_TRUE(std::equal(boundary.points.begin(), boundary.points.end(), tri.points.begin()));
    for (const auto& t : tri.triangles)
      for (int k = 0; k < 3; ++k) {
        const int a = t[k], b = t[(k + 1) % 3];
        if (std::max(a, b) < tri.n_boundary) continue;
        int hint = -1;
        EXPECT_GT(norm(tri.points[a] - tri.points[b]),
                  0.6 * FrontalOptions{}.rejection * size.at(tri.points[b], hint));
      }
  }
}

TEST_P(Insertion, ResolvesAlmostEverything) {
  const auto boundary = shapes::plate_with_holes(2, 100, 4, 0.14, 44);
  const TriPatch tri = insert(boundary, FunctionCross(0.2), FunctionSize(0.02));
  EXPECT_LT(summary_.unresolved, 0.02 * tri.triangles.size());
}

/// All boundary edges are as long as the coarse size; only triangles inside can see the source. Packing
/// cannot begin there, and the filler has to do it all.
TEST_P(LinfInsertion, FindsASmallSizeInsideACoarseBoundary) {
  const FunctionSize size([](Vec2 u) { return std::min(0.5, 0.01 + 0.5 * norm(u - Vec2{0.31, 0.29})); });
  const TriPatch tri = insert(shapes::rectangle(1, 1, 2, 2), FunctionCross(0), size);
  EXPECT_LT(summary_.packed, summary_.inserted);
  double nearest = INFINITY;
  for (const Vec2 p : tri.points) nearest = std::min(nearest, norm(p - Vec2{0.31, 0.29}));
  EXPECT_LT(nearest, 0.02);
}

TEST_P(Insertion, SameBytesTwice) {
  const auto boundary = shapes::random_polygon_with_holes(7, 0.03);
  const auto once = insert(boundary, FunctionCross(0.3), FunctionSize(0.03));
  const auto twice = insert(boundary, FunctionCross(0.3), FunctionSize(0.03));
  ASSERT_EQ(once.points, twice.points);
  ASSERT_EQ(once.triangles, twice.triangles);
}

// Powers of two scale and shift without rounding, so that the mesh follows exactly.
TEST_P(LinfInsertion, ScalesWithItsInput) {
  auto boundary = shapes::plate_with_holes(1, 16, 2, 0.125, 12);
  const auto base = insert(boundary, FunctionCross(0.1), FunctionSize(0.0625));
  for (Vec2& p : boundary.points) p = 8.0 * p;
  const auto scaled = insert(boundary, FunctionCross(0.1), FunctionSize(0.5));
  ASSERT_EQ(base.triangles, scaled.triangles);
  for (size_t i = 0; i < base.points.size(); ++i) EXPECT_EQ(scaled.points[i], 8.0 * base.points[i]);
}

TEST_P(LinfInsertion, StopsAtMaxPointsAndSaysSo) {
  insert(shapes::rectangle(1, 1, 50, 50), FunctionCross(0), FunctionSize(0.02), {.max_points = 10});
  EXPECT_EQ(summary_.termination, FrontalTermination::kMaxPoints);
  EXPECT_EQ(summary_.inserted, 10);
}

TEST_P(Insertion, SliverDomainsEnd) {
  for (const double height : {1e-3, 1e-6, 1e-9})
    insert(shapes::rectangle(1, height, 10, 1), FunctionCross(0), FunctionSize(0.1));
  insert(shapes::polygon({{0, 0}, {1, 0}, {1, 0.01}}, 4), FunctionCross(0), FunctionSize(0.002));
}

TEST(FrontalMesher, VertexRatioOfTheNormsIsTwoOverRootThree) {
  const auto boundary = shapes::rectangle(1, 1, 150, 150);
  const FunctionSize size(1.0 / 150);
  const double f = mesh_frontal(boundary, *make_l2_frontal(), FunctionCross(0), size).points.size();
  const double d = mesh_frontal(boundary, *make_linf_delquad(), FunctionCross(0), size).points.size();
  EXPECT_NEAR(f / d / (2 / std::numbers::sqrt3), 1, 0.03);
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
  const auto [points, triangles] = on_threads({1, 2, 3, 7}, [&] {
    const TriPatch tri = mesh_frontal(boundary, *make_linf_delquad(), FunctionCross(0.3), size);
    return std::pair(tri.points, tri.triangles);
  });
  EXPECT_GT(triangles.size(), without.triangles.size() + 2000);
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
  const TriPatch tri = mesh_packing(shapes::polygon(corners, 1), *make_linf_delquad(),
                                    FunctionCross([](Vec2 u) { return std::atan2(u.y, u.x); }),
                                    FunctionSize([&](Vec2 u) { return step * norm(u); }), {}, &summary);
  EXPECT_EQ(summary.packed, (kOut - 1) * (kAround - 1));
  EXPECT_EQ(tri.triangles.size(), 2u * kOut * kAround);
  for (const Vec2 p : tri.points) {
    const double i = std::log(norm(p)) / step, j = std::atan2(p.y, p.x) / step;
    EXPECT_NEAR(i, std::round(i), 0.01);
    EXPECT_NEAR(j, std::round(j), 0.01);
  }
}

// Sizes such as sqrt(1 - r^2) exist inside only. Points of the boundary may be outside by rounding.
TEST(Packing, AsksNoFieldOutsideTheDomain) {
  const auto expect_inside = [](Vec2 u) {
    const double r = norm(u);
    EXPECT_TRUE(r < 1 + 1e-12 && r > 0.3 * std::cos(std::numbers::pi / 30) - 1e-12) << u.x << ", " << u.y;
  };
  const FunctionSize size([&](Vec2 u) { return expect_inside(u), 0.05 + 0.05 * norm(u); });
  const FunctionCross cross([&](Vec2 u) { return expect_inside(u), std::atan2(u.y, u.x) + 0.2; });
  const TriPatch tri = mesh_packing(shapes::annulus(0.3, 1, 30, 70), *make_linf_delquad(), cross, size);
  EXPECT_GT(tri.points.size(), 400u);
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
