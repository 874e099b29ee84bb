// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/fields/sampled_fields.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

using PointFunction = std::function<double(const Vec3&)>;

/// A function of a batch, which counts its calls and points.
struct Counted {
  PointFunction function;
  int calls = 0;
  std::size_t points = 0;
  SizeFunction as_size() {
    return [this](std::span<const Vec3> x, std::span<double> delta) {
      ++calls;
      points += x.size();
      for (std::size_t i = 0; i < x.size(); ++i) delta[i] = function(x[i]);
    };
  }
};

const SampleDomain kUnitSquare = {{{0, 0, 0}, {1, 1, 0}}};

std::shared_ptr<const SizeField> sampled(const PointFunction& function,
                                         const SampleDomain& domain = kUnitSquare) {
  Counted counted{function};
  std::vector<Warning> warnings;
  auto size = sample_size(counted.as_size(), domain, "the size function", warnings);
  EXPECT_TRUE(warnings.empty());
  return size;
}

double at(const SizeField& size, const Vec3& x) {
  int hint = -1;
  return size.at(x, hint);
}

/// The largest relative error at random points of the unit square or cube.
double error_of(const SizeField& size, const PointFunction& function, bool in_space = false) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> part(0, 1);
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 x{part(random), part(random), in_space ? part(random) : 0};
    worst = std::max(worst, std::abs(at(size, x) / function(x) - 1));
  }
  return worst;
}

TEST(SampledSize, ConstantBecomesAConstant) {
  Counted counted{[](const Vec3&) { return 0.25; }};
  std::vector<Warning> warnings;
  const auto size = sample_size(counted.as_size(), kUnitSquare, "f", warnings);
  EXPECT_EQ(at(*size, {17, -3, 2}), 0.25);
  EXPECT_EQ(counted.calls, 1);
  EXPECT_LT(counted.points, 20'000u);
}

TEST(SampledSize, IsExactWhereLinear) {
  const PointFunction f = [](const Vec3& x) { return 0.1 + x.x + 2 * x.y; };
  EXPECT_LT(error_of(*sampled(f), f), 1e-13);
}

TEST(SampledSize, FollowsSmoothFunctionsToItsTolerance) {
  for (const PointFunction& f : {
           PointFunction([](const Vec3& x) { return 0.001 + 0.1 * x.x * x.x + 0.05 * x.y; }),
           PointFunction(
               [](const Vec3& x) { return 0.02 + 0.019 * std::sin(40 * x.x) * std::cos(30 * x.y); }),
           PointFunction([](const Vec3& x) { return 0.001 + 0.2 * std::hypot(x.x - 0.3, x.y - 0.7); }),
       })
    EXPECT_LT(error_of(*sampled(f), f), 3 * kSampledSizeError);
}

TEST(SampledSize, FindsAJumpToAQuarterOfTheSize) {
  const PointFunction f = [](const Vec3& x) { return x.x < 0.3 ? 0.01 : 0.1; };
  const auto size = sampled(f);
  EXPECT_EQ(at(*size, {0.3 - 0.0026, 0.4, 0}), 0.01);
  EXPECT_EQ(at(*size, {0.3 + 0.0026, 0.4, 0}), 0.1);
}

TEST(SampledSize, SeesANarrowValley) {
  const PointFunction f = [](const Vec3& x) {
    return 0.001 + 0.1 * std::min(1.0, 50 * std::abs(x.x - 0.7171));
  };
  EXPECT_LT(at(*sampled(f), {0.7171, 0.5, 0}), 0.0015);
}

TEST(SampledSize, InSpaceSamplesLieBesideTheSurface) {
  Mesh sphere;  // an octahedron
  sphere.points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (const int x : {0, 1})
    for (const int y : {2, 3})
      for (const int z : {4, 5}) sphere.triangles.push_back({x, y, z});
  const PointFunction f = [](const Vec3& x) { return 0.01 + 0.1 * dot(x, x); };
  Counted everywhere{f}, beside{f};
  std::vector<Warning> warnings;
  const Box<Vec3> box{{-1, -1, -1}, {1, 1, 1}};
  sample_size(everywhere.as_size(), {box}, "f", warnings);
  const auto size = sample_size(beside.as_size(), {box, &sphere}, "f", warnings);
  EXPECT_LT(3 * beside.points, everywhere.points);
  for (const auto& [a, b, c] : sphere.triangles) {
    const Vec3 x = (1.0 / 3) * (sphere.points[a] + sphere.points[b] + sphere.points[c]);
    EXPECT_NEAR(at(*size, x), f(x), 2 * kSampledSizeError * f(x));
  }
}

TEST(SampledSize, PlanesNeedNotBeHorizontal) {
  const PointFunction f = [](const Vec3& x) { return 0.1 + x.y * x.z; };
  const auto size = sampled(f, {{{5, 0, 0}, {5, 1, 1}}});
  EXPECT_NEAR(at(*size, {5, 0.31, 0.77}), f({5, 0.31, 0.77}), kSampledSizeError);
}

TEST(SampledSize, NamesThePlaceOfAValueThatIsNoSize) {
  const std::string all = message_of([] { sampled([](const Vec3&) { return NAN; }); });
  EXPECT_NE(all.find("the size function is nan at ("), std::string::npos) << all;
  for (const double bad : {0.0, -1.0, double(INFINITY)})
    EXPECT_THROW(sampled([=](const Vec3&) { return bad; }), InputError);
  const auto half = sampled([](const Vec3& x) { return x.x - 0.5; });
  EXPECT_NEAR(at(*half, {0.75, 0.5, 0}), 0.25, 1e-9);
  const std::string some = message_of([&] { at(*half, {0.25, 0.5, 0}); });
  EXPECT_TRUE(holds(some, "the size function is -0.", "expected a finite length > 0"));
}

TEST(SampledSize, AFunctionThatWritesNothingIsRefused) {
  std::vector<Warning> warnings;
  EXPECT_THROW(sample_size([](std::span<const Vec3>, std::span<double>) {}, kUnitSquare, "f", warnings),
               InputError);
}

TEST(SampledSize, ValuesThatAreNoneBesideTheDomainDoNotCount) {
  // A ring that the function fits: inside of it there is no logarithm to speak of.
  const PointFunction f = [](const Vec3& x) { return 0.1 * std::log(std::hypot(x.x, x.y)); };
  const auto size = sampled(f, {{{-2, -2, 0}, {2, 2, 0}}});
  for (int k = 0; k < 100; ++k) {
    const Vec3 x{1.05 * std::cos(k), 1.05 * std::sin(k), 0};
    EXPECT_NEAR(at(*size, x), f(x), 0.02 * f(x));
  }
}

TEST(SampledSize, TooManySamplesAreWarnedOf) {
  Counted noise{[](const Vec3& x) { return 1e-6 * (1.5 + std::sin(1e7 * x.x + 1.3e7 * x.y)); }};
  std::vector<Warning> warnings;
  sample_size(noise.as_size(), kUnitSquare, "the size function", warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(holds(warnings[0].text, "the size function varies so much"));
}

TEST(SampledSize, ExceptionsPassThrough) {
  struct Own {};
  std::vector<Warning> warnings;
  EXPECT_THROW(
      sample_size([](std::span<const Vec3>, std::span<double>) { throw Own(); }, kUnitSquare, "f", warnings),
      Own);
}

TEST(SampledCross, TurnsAsTheFunctionDoes) {
  // Around the middle, where the angle jumps by a turn that crosses do not see.
  const CrossFunction around = [](std::span<const Vec2> x, std::span<double> theta) {
    for (std::size_t i = 0; i < x.size(); ++i) theta[i] = std::atan2(x[i].y - 0.5, x[i].x - 0.5);
  };
  std::vector<Warning> warnings;
  const auto cross = sample_cross(around, kUnitSquare, *make_constant_size(0.02), "f", warnings);
  for (int k = 0; k < 200; ++k) {
    const Vec2 d = 0.3 * Vec2{std::cos(k), std::sin(k)};
    int hint = -1;
    const double off = cross->at(Vec2{0.5, 0.5} + d, hint).angle() - std::atan2(d.y, d.x);
    constexpr double kQuarter = std::numbers::pi / 2;
    EXPECT_LT(std::abs(off - kQuarter * std::round(off / kQuarter)), kSampledCrossError);
  }
  const CrossFunction none = [](std::span<const Vec2>, std::span<double>) {};
  EXPECT_THROW(sample_cross(none, kUnitSquare, *make_constant_size(0.02), "f", warnings), InputError);
}

}  // namespace
}  // namespace delquad
