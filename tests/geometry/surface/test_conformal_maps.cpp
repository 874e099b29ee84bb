// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/conformal_maps.h"
#include "geometry/surface/flatten.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

Chart chart_of(const SurfaceModel& model) {
  return extract_charts(model.fine, std::vector<char>(model.fine.triangles.size(), 1))[0];
}

// Largest relative change of a side's length, after the best common scale.
double length_error(const Chart& chart, const std::vector<Vec2>& flat) {
  double in_space = 0, in_plane = 0, worst = 0;
  auto each_side = [&](auto f) {
    for (const auto& v : chart.triangles)
      for (int k = 0; k < 3; ++k)
        f(norm(chart.points[v[k]] - chart.points[v[(k + 1) % 3]]), norm(flat[v[k]] - flat[v[(k + 1) % 3]]));
  };
  each_side([&](double l, double f) {
    in_space += l;
    in_plane += f;
  });
  each_side(
      [&](double l, double f) { worst = std::max(worst, std::abs(f * in_space / (l * in_plane) - 1)); });
  return worst;
}

SurfaceModel half_cylinder(int n) {
  return grid_surface({n, n}, [](double u, double v) {
    return Vec3{2 * std::cos(std::numbers::pi * u), 2 * std::sin(std::numbers::pi * u), 5 * v + u};
  });
}

TEST(ConformalMaps, DevelopableDisksUnrollExactly) {
  const Chart chart = chart_of(half_cylinder(9));
  EXPECT_LT(length_error(chart, boundary_first_map(chart)), 1e-9);
  EXPECT_LT(length_error(chart, spectral_map(chart)), 1e-6);  // an iteration, and a shift of 1e-9
}

TEST(ConformalMaps, PlanesKeepTheirShape) {
  const SurfaceModel model = grid_surface({5, 7}, [](double u, double v) {
    return Vec3{u, v + 0.3 * u, 2 * u - v + 4};
  });
  const Chart chart = chart_of(model);
  const auto flat = planar_map(chart, 1e-9);
  ASSERT_TRUE(flat);
  EXPECT_LT(length_error(chart, *flat), 1e-12);
  EXPECT_TRUE(is_one_to_one(chart, *flat));
  EXPECT_FALSE(planar_map(chart_of(bump(5, 0.1)), 1e-9));
}

// The cap's map is stereographic: the scale at polar angle theta is C / (1 + cos theta), with C such that the
// boundary keeps its length.
TEST(ConformalMaps, SphereCapIsStereographic) {
  constexpr double kCap = 1.2;
  double last = 1;
  for (int n : {10, 20, 40}) {
    const Chart chart = chart_of(sphere_cap(4 * n, n, kCap));
    const std::vector<Vec2> flat = boundary_first_map(chart);
    ASSERT_TRUE(is_one_to_one(chart, flat));
    const Vec2 pole = flat[std::ranges::find(chart.points, Vec3{0, 0, 1}) - chart.points.begin()];
    double worst = 0;
    for (std::size_t v = 0; v < flat.size(); ++v) {
      const double theta = std::acos(std::min(1.0, chart.points[v].z));
      const double expected = (1 + std::cos(kCap)) * std::tan(theta / 2);
      worst = std::max(worst, std::abs(norm(flat[v] - pole) - expected));
    }
    EXPECT_LT(worst, 0.35 * last);  // second order
    last = worst;
  }
  EXPECT_LT(last, 2e-3);
}

// An annulus of a plane mapped uncut, although it does not lie in one plane: a cone's frustum. Its map is a
// power of the radius: w = s^sin(half angle) along the slant side s.
TEST(ConformalMaps, FrustumIsAPowerOfTheRadius) {
  constexpr double kHalfAngle = 1.0, kInner = 0.5;
  const SurfaceModel model = grid_surface({96, 24, true}, [](double u, double v) {
    const double phi = 2 * std::numbers::pi * u, s = kInner + (1 - kInner) * v;
    return Vec3{s * std::sin(kHalfAngle) * std::cos(phi), s * std::sin(kHalfAngle) * std::sin(phi),
                -s * std::cos(kHalfAngle)};
  });
  const Chart chart = chart_of(model);
  const std::vector<Vec2> flat = spectral_map(chart);
  ASSERT_TRUE(is_one_to_one(chart, flat));
  double sum[2] = {0, 0};
  Vec2 centre;
  for (int v : chart.loops[0]) centre += (1.0 / static_cast<double>(chart.loops[0].size())) * flat[v];
  for (int l = 0; l < 2; ++l)
    for (int v : chart.loops[l])
      sum[l] += norm(flat[v] - centre) / static_cast<double>(chart.loops[l].size());
  EXPECT_NEAR(sum[1] / sum[0], std::pow(kInner, 1 / std::sin(kHalfAngle)), 2e-3);
  EXPECT_LT(measure_flat(chart, flat).sigma_95, 1.02);
}

TEST(ConformalMaps, RoughDisksStayOneToOne) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    double a[6];
    for (double& x : a) x = 4.0 * (static_cast<double>(random()) / 4294967296.0 - 0.5);
    const SurfaceModel model = grid_surface({30, 30}, [&](double u, double v) {
      const double x = 2 * u - 1, y = 2 * v - 1;
      return Vec3{x + 0.2 * a[0] * y * y, y,
                  0.1 * (a[1] * std::sin(4 * x + a[2]) + a[3] * std::cos(5 * y + a[4] * x) + a[5] * x * y)};
    });
    const Chart chart = chart_of(model);
    for (const auto& flat : {boundary_first_map(chart), spectral_map(chart)}) {
      ASSERT_TRUE(is_one_to_one(chart, flat)) << "seed " << seed;
      EXPECT_LT(measure_flat(chart, flat).sigma_95, 1.15) << "seed " << seed;
    }
  }
}

TEST(ConformalMaps, StayOpenWhereTheBoundaryTurnsBackOntoItself) {
  // Triangles around one point of the boundary, a wave with more angle there than the plane has.
  constexpr int kTriangles = 24;
  constexpr double kDegree = std::numbers::pi / 180, kStep = 358 * kDegree / kTriangles;
  for (const double angle : {350.0, 359.9, 365.0, 375.0}) {
    const double c = std::cos(std::max(angle * kDegree / kTriangles, kStep));
    const double step = std::min(angle * kDegree / kTriangles, kStep);
    const double height = std::sqrt((std::cos(step) - c) / (1 + c));
    Mesh fan;
    fan.points.push_back({});
    for (int i = 0; i <= kTriangles; ++i)
      fan.points.push_back({std::cos(i * step), std::sin(i * step), i % 2 == 0 ? height : -height});
    for (int i = 1; i <= kTriangles; ++i) fan.triangles.push_back({0, i, i + 1});
    fan.triangle_region.assign(kTriangles, 0);
    fan.regions.push_back({1, {}});
    const Chart chart = chart_of(make_surface_model(fan, {.feature_angle = 180}));
    EXPECT_TRUE(is_one_to_one(chart, boundary_first_map(chart))) << angle;
  }
}

TEST(FlatCheck, SeesFlipsCrossingsAndTouching) {
  // A strip that winds around twice as it is laid flat: no triangle is flipped, but it covers itself.
  const SurfaceModel strip = grid_surface({60, 2}, [](double u, double v) { return Vec3{20 * u, v, 0}; });
  const Chart chart = chart_of(strip);
  auto wound = [&](double turns) {
    std::vector<Vec2> flat;
    for (const Vec3& p : chart.points) {
      const double phi = -2 * std::numbers::pi * turns * p.x / 20, r = 2 + p.y;
      flat.push_back({r * std::cos(phi), r * std::sin(phi)});
    }
    return flat;
  };
  EXPECT_TRUE(is_one_to_one(chart, wound(0.9)));
  EXPECT_FALSE(is_one_to_one(chart, wound(1.1)));
  EXPECT_FALSE(is_one_to_one(chart, wound(-0.5)));  // a mirror image
  std::vector<Vec2> flat = wound(0.9);
  flat[5] = flat[7];
  EXPECT_FALSE(is_one_to_one(chart, flat));
  flat = wound(0.9);
  flat[3].x = std::nan("");
  EXPECT_FALSE(is_one_to_one(chart, flat));
}

TEST(FlatCheck, MeasuresStretch) {
  const Chart chart = chart_of(grid_surface({6, 6}, [](double u, double v) { return Vec3{u, v, 0}; }));
  std::vector<Vec2> flat;
  for (const Vec3& p : chart.points) flat.push_back({3 * p.x, 2 * p.y + p.x});
  // The matrix ((3, 0), (1, 2)): singular values are the roots of s^4 - 14 s^2 + 36.
  const double root = std::sqrt(49.0 - 36.0);
  const FlatQuality q = measure_flat(chart, flat);
  EXPECT_NEAR(q.sigma_mean, std::sqrt((7 + root) / (7 - root)), 1e-12);
  EXPECT_NEAR(q.sigma_max, q.sigma_mean, 1e-12);
  EXPECT_NEAR(q.area_ratio, 1, 1e-12);
}

}  // namespace
}  // namespace delquad
