// SPDX-License-Identifier: GPL-3.0-or-later
#include <complex>
#include "algorithms/fields/size_aware_cross_field.h"
#include "tests/algorithms/fields/backgrounds.h"

namespace delquad {
namespace {

using Complex = std::complex<double>;

/// Angle between two crosses, in [0, pi/4].
double angle_apart(double theta, double other) {
  return std::abs(std::remainder(theta - other, std::numbers::pi / 2));
}

Complex as_complex(Vec2 u) { return {u.x, u.y}; }
Vec2 as_vec(Complex w) { return {w.real(), w.imag()}; }

/// Root mean square of the angle between two fields, over random points.
double rms_apart(const TriPatch& tri, const CrossField& a, const CrossField& b) {
  constexpr int kPoints = 2000;
  std::mt19937_64 random(1);
  double sum = 0;
  int hint_a = -1, hint_b = -1;
  for (int i = 0; i < kPoints; ++i) {
    const Vec2 u = random_point(tri, random);
    const double angle = angle_apart(a.at(u, hint_a).angle(), b.at(u, hint_b).angle());
    sum += angle * angle / kPoints;
  }
  return std::sqrt(sum);
}

const FunctionSize kWavy([](Vec2 u) { return 0.02 * (1 + 0.8 * std::sin(4 * u.x + 1) * std::cos(3 * u.y)); });

TEST(SizeAwareCross, ConstantSizesLeaveTheStartAsItIs) {
  const auto background = background_of(shapes::random_polygon_with_holes(8, 0.05));
  const auto start = std::make_shared<HarmonicCrossField>(background);
  // Half a per cent across the domain is too little for a row of quads to end.
  for (const double slope : {0.0, 1e-3}) {
    const FunctionSize size([&](Vec2 u) { return 0.1 * (1 + slope * u.x); });
    const SizeAwareCrossField field(background, size, start);
    EXPECT_EQ(field.index_sum(), 4 * field.euler_characteristic());
    std::mt19937_64 random(1);
    int hint = -1, start_hint = -1;
    for (int i = 0; i < 300; ++i) {
      const Vec2 u = random_point(background->triangles(), random);
      const Cross a = field.at(u, hint), b = start->at(u, start_hint);
      ASSERT_EQ(a.c, b.c);
      ASSERT_EQ(a.s, b.s);
    }
  }
}

// Where delta = |f'|, squares are carried to squares: the field is the field of the grid's image, theta = arg
// f'.
TEST(SizeAwareCross, IsThatOfConformalGrids) {
  struct Map {
    const char* name;
    std::function<Complex(Complex)> f, slope;
  };
  const Map maps[] = {
      {"exponential", [](Complex w) { return std::exp(w); }, [](Complex w) { return std::exp(w); }},
      {"square", [](Complex w) { return (w + 0.5) * (w + 0.5); }, [](Complex w) { return 2.0 * (w + 0.5); }},
      {"reciprocal", [](Complex w) { return 1.0 / (w + Complex(0.6, 0.4)); },
       [](Complex w) { return -1.0 / ((w + Complex(0.6, 0.4)) * (w + Complex(0.6, 0.4))); }}};
  for (const Map& map : maps) {
    double error[2];
    for (int level = 0; level < 2; ++level) {
      const double step = level == 0 ? 1.0 / 16 : 1.0 / 32;
      const auto background =
          image_of_grid(1.5, 1, step, [&](Vec2 w) { return as_vec(map.f(as_complex(w))); });
      const auto inverse = [&](Vec2 u) {  // by Newton from the nearest of a few points
        Complex w = 0, best = 0;
        for (int i = 0; i <= 12; ++i) {
          for (int j = 0; j <= 8; ++j) {
            w = {i / 8.0, j / 8.0};
            if (std::abs(map.f(w) - as_complex(u)) < std::abs(map.f(best) - as_complex(u))) best = w;
          }
        }
        for (int i = 0; i < 8; ++i) best -= (map.f(best) - as_complex(u)) / map.slope(best);
        return best;
      };
      const FunctionSize size([&](Vec2 u) { return step * std::abs(map.slope(inverse(u))); });
      const FunctionCross exact([&](Vec2 u) { return std::arg(map.slope(inverse(u))); });
      const SizeAwareCrossField field(background, size, std::make_shared<HarmonicCrossField>(background));
      EXPECT_TRUE(field.singularities().empty()) << map.name;
      EXPECT_EQ(field.index_sum(), 4);
      error[level] = rms_apart(background->triangles(), field, exact);
    }
    EXPECT_LT(error[0], 0.03) << map.name;
    EXPECT_LT(error[1], 0.6 * error[0]) << map.name;
  }
}

TEST(SizeAwareCross, HasFewerDislocationsThanTheHarmonicField) {
  const auto background = image_of_grid(2, 1, 0.02, [](Vec2 w) { return w; });
  const auto start = std::make_shared<HarmonicCrossField>(background);
  const SizeAwareCrossField field(background, kWavy, start);
  EXPECT_LT(expected_dislocations(*background, field, kWavy),
            0.7 * expected_dislocations(*background, *start, kWavy));
  EXPECT_FALSE(field.singularities().empty());
  EXPECT_EQ(field.index_sum(), 4);
}

TEST(SizeAwareCross, LiesAlongTheBoundary) {
  const auto background = image_of_grid(2, 1, 0.05, [](Vec2 w) { return Vec2{w.x + 0.2 * w.y * w.y, w.y}; });
  const SizeAwareCrossField field(background, kWavy, std::make_shared<HarmonicCrossField>(background));
  const TriPatch& tri = background->triangles();
  int hint = -1;
  for (size_t t = 0; t < tri.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (tri.neighbours[t][k] >= 0) continue;
      const Vec2 a = tri.points[tri.triangles[t][(k + 1) % 3]], b = tri.points[tri.triangles[t][(k + 2) % 3]];
      EXPECT_LE(angle_apart(field.at(0.5 * (a + b), hint).angle(), std::atan2(b.y - a.y, b.x - a.x)), 1e-9);
    }
  }
}

TEST(SizeAwareCross, TurnsAndScalesWithTheDomain) {
  const double angle = 0.3, scale = 8;
  const Vec2 axis = scale * Vec2{std::cos(angle), std::sin(angle)};
  const auto move = [&](Vec2 u) { return u.x * axis + u.y * perp(axis); };
  const auto back = [&](Vec2 u) {
    return Vec2{dot(u, axis) / (scale * scale), dot(u, perp(axis)) / (scale * scale)};
  };
  // A grid of diamonds has one Delaunay triangulation only, which turns with it.
  const auto shape = [](Vec2 w) { return Vec2{w.x + 0.3 * w.y, w.y}; };
  const auto background = image_of_grid(2, 1, 0.04, shape);
  const auto moved = image_of_grid(2, 1, 0.04, [&](Vec2 w) { return move(shape(w)); });
  const FunctionSize moved_size([&](Vec2 u) {
    int hint = -1;
    return scale * kWavy.at(back(u), hint);
  });
  const SizeAwareCrossField field(background, kWavy, std::make_shared<HarmonicCrossField>(background));
  const SizeAwareCrossField moved_field(moved, moved_size, std::make_shared<HarmonicCrossField>(moved));
  ASSERT_EQ(field.singularities().size(), moved_field.singularities().size());
  std::mt19937_64 random(1);
  int hint = -1, moved_hint = -1;
  for (int i = 0; i < 500; ++i) {
    const Vec2 u = random_point(background->triangles(), random);
    const Cross a = field.at(u, hint), b = moved_field.at(move(u), moved_hint);
    const Complex turned = Complex(a.c, a.s) * std::polar(1.0, 4 * angle);
    EXPECT_LT(std::abs(turned - Complex(b.c, b.s)), 0.01);
  }
  EXPECT_NEAR(expected_dislocations(*background, field, kWavy),
              expected_dislocations(*moved, moved_field, moved_size),
              0.01 * expected_dislocations(*background, field, kWavy));
}

TEST(SizeAwareCross, IndexSumIsEulersOnRandomPolygons) {
  const FunctionSize steep([](Vec2 u) { return 0.02 * std::exp(6 * std::sin(7 * u.x) * std::cos(5 * u.y)); });
  for (unsigned seed = 0; seed < 60; ++seed) {
    const auto background = background_of(shapes::random_polygon_with_holes(seed, seed % 2 ? 0.05 : 0));
    const SizeAwareCrossField field(background, steep, std::make_shared<HarmonicCrossField>(background));
    EXPECT_EQ(field.index_sum(), 4 * field.euler_characteristic()) << seed;
    std::mt19937_64 random(seed);
    int hint = -1;
    for (int i = 0; i < 20; ++i) {
      const Cross z = field.at(random_point(background->triangles(), random), hint);
      EXPECT_TRUE(std::isfinite(z.c) && std::isfinite(z.s));
    }
  }
}

TEST(ExpectedDislocations, ClosedForms) {
  // Crosses along the axes, delta growing in x: each unit length of a column loses slope/delta rows.
  const auto background = image_of_grid(1, 1, 0.02, [](Vec2 w) { return w; });
  const FunctionSize linear([](Vec2 u) { return 0.01 * (1 + u.x); });
  // Integral of (0.01/delta)/delta over the square, exact: 100 (1 - 1/2).
  EXPECT_NEAR(expected_dislocations(*background, FunctionCross(0), linear), 50, 0.5);
  EXPECT_NEAR(expected_dislocations(*background, FunctionCross(0), FunctionSize(0.01)), 0, 1e-9);
  // At 45 degrees both directions share the loss.
  EXPECT_NEAR(expected_dislocations(*background, FunctionCross(std::numbers::pi / 4), linear),
              50 * std::numbers::sqrt2, 0.7);
  // The grid of the exponential map has none.
  const FunctionSize radial([](Vec2 u) { return 0.01 * norm(u + Vec2{1, 0}); });
  const FunctionCross polar([](Vec2 u) { return std::atan2(u.y, u.x + 1); });
  EXPECT_LT(expected_dislocations(*background, polar, radial), 0.5);
}

}  // namespace
}  // namespace delquad
