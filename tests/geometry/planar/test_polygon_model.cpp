// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/curves/mesh_planar_curves.h"
#include "geometry/planar/sampled_curve.h"
#include "tests/geometry/planar/models.h"

namespace delquad {
namespace {

TEST(Polygons, HolesAreInside) {
  const PlanarModel model = polygons({{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {{1, 1}, {2, 1}, {2, 2}}});
  const PlanarDomain domain = make_domain(model, constant(0.5));
  ASSERT_EQ(domain.patches.size(), 1u);
  double area = 0;
  for (const auto& [i, j] : domain.patches[0].edges)
    area += cross(domain.patches[0].points[i], domain.patches[0].points[j]) / 2;
  EXPECT_NEAR(area, 15.5, 1e-12);
  for (const Vec2 corner : {Vec2{4, 4}, Vec2{2, 1}})
    EXPECT_NE(std::ranges::find(domain.patches[0].points, corner), domain.patches[0].points.end());
}

TEST(Polygons, RefusesWhatIsNone) {
  EXPECT_EQ(message_of([] { polygons({}); }), "polygons: there are none");
  const std::vector<std::vector<Vec2>> two = {{{0, 0}, {1, 0}}};
  EXPECT_EQ(message_of([&] { polygons(two); }), "polygon 1: 2 corners: expected at least three");
  expect_input_error([] { polygons({{{0, 0}, {1, 0}, {1, 1}, {0, 0}}}); }, {"closes by itself"});
  expect_input_error([] { polygons({{{0, 0}, {1, 0}, {NAN, 1}}}); }, {"polygon 1: point 3"});
}

CurveFunction function_of(Vec2 (*f)(double), int* calls = nullptr) {
  return [=](std::span<const double> t, std::span<Vec2> points) {
    if (calls != nullptr) ++*calls;
    for (std::size_t i = 0; i < t.size(); ++i) points[i] = f(t[i]);
  };
}

TEST(SampledCurve, FollowsSmoothFunctionsInFewCalls) {
  const auto f = [](double t) {
    return Vec2{std::cos(t) * (2 + std::sin(7 * t)), std::sin(t) * (2 + std::sin(7 * t))};
  };
  int calls = 0;
  const auto curve = make_sampled_curve(function_of(f, &calls), 0, 6);
  EXPECT_LT(calls, 12);
  for (int k = 0; k <= 1000; ++k) {
    const Vec2 wanted = f(6 * (k / 1000.0));
    EXPECT_LT(norm(curve->point(k / 1000.0) - wanted), 10 * 6 * kSampledCurveError);
  }
  EXPECT_EQ(curve->point(0), f(0));
  EXPECT_EQ(curve->point(1), f(6));
}

TEST(SampledCurve, FollowsAKink) {
  const auto f = [](double t) { return Vec2{t, std::abs(t - 0.3)}; };
  const auto curve = make_sampled_curve(function_of(f), 1, 0);
  for (int k = 0; k <= 1000; ++k) EXPECT_LT(norm(curve->point(k / 1000.0) - f(1 - k / 1000.0)), 1e-6);
}

TEST(SampledCurve, RefusesWhatCannotBeFollowed) {
  const auto refused = [](Vec2 (*f)(double), double from, double to, const char* says) {
    expect_input_error([&] { make_sampled_curve(function_of(f), from, to); }, {says});
  };
  refused([](double t) { return Vec2{t, std::sin(1e9 * t)}; }, 0, 1, "cannot be followed");
  refused([](double t) { return Vec2{t, std::log(t - 1)}; }, 0, 1, "finite coordinates");
  refused([](double t) { return Vec2{t, t}; }, 1, 1, "");
  refused([](double t) { return Vec2{t, t}; }, 0, NAN, "");
}

}  // namespace
}  // namespace delquad
