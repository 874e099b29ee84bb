// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/algorithms/fields/backgrounds.h"

namespace delquad {
namespace {

double at(const SizeField& size, double x, double y, double z = 0) {
  int hint = -1;
  return size.at({x, y, z}, hint);
}

TEST(ConstantSize, IsConstantAndChecked) {
  EXPECT_EQ(at(*make_constant_size(0.25), 3, 4), 0.25);
  for (const double bad : {0.0, -1.0, double(NAN), double(INFINITY)})
    EXPECT_THROW(make_constant_size(bad), InputError);
}

TEST(ExpressionSize, EvaluatesItsVariables) {
  EXPECT_NEAR(at(*make_expression_size("0.1 + x + 2*y + 4*z"), 1, 2, 3), 17.1, 1e-14);
}

TEST(ExpressionSize, NamesThePointWhereItIsNoSize) {
  const std::string text = message_of([] { at(*make_expression_size("x-1"), 0.8, 0); });
  EXPECT_EQ(text.substr(0, 21), "size field 'x-1' is -");
  EXPECT_TRUE(holds(text, "at (0.8, 0, 0): expected a finite length > 0"));
  EXPECT_THROW(at(*make_expression_size("sqrt(x)"), -1, 0), InputError);
  EXPECT_THROW(at(*make_expression_size("1/x"), 0, 0), InputError);
  EXPECT_THROW(make_expression_size("1 +"), InputError);
}

TEST(SourceSize, IsLinearBetweenTheRadii) {
  const auto size = make_source_size(nullptr, {{{0, 0, 0}, {1, 0, 0}, 0.1, 0.5, 0.2, 1.0}});
  EXPECT_EQ(at(*size, 0.5, 0), 0.1);
  EXPECT_EQ(at(*size, 0.5, 0.2), 0.1);
  EXPECT_NEAR(at(*size, 0.5, -0.6), 0.3, 1e-15);
  EXPECT_NEAR(at(*size, 1.6, 0), 0.3, 1e-15);
  EXPECT_NEAR(at(*size, 0.5, 0, 0.6), 0.3, 1e-15);
  EXPECT_EQ(at(*size, 5, 0), 0.5);
}

TEST(SourceSize, SmallestWins) {
  const auto size = make_source_size(make_constant_size(0.3), {{{0, 0, 0}, {0, 0, 0}, 0.1, 0.5, 0, 1},
                                                               {{2, 0, 0}, {2, 0, 0}, 0.01, 5, 0.1, 0.1}});
  EXPECT_EQ(at(*size, 0, 0), 0.1);
  EXPECT_EQ(at(*size, 2, 0.1), 0.01);
  EXPECT_EQ(at(*size, 2, 0.2), 0.3);
  EXPECT_EQ(at(*size, 0.9, 0), 0.3);
}

TEST(SourceSize, RefusesNonsense) {
  EXPECT_THROW(make_source_size(nullptr, {}), InputError);
  EXPECT_THROW(make_source_size(nullptr, {{{}, {}, 0, 1, 0, 1}}), InputError);
  EXPECT_THROW(make_source_size(nullptr, {{{}, {}, 1, NAN, 0, 1}}), InputError);
  EXPECT_THROW(make_source_size(nullptr, {{{}, {}, 1, 1, 2, 1}}), InputError);
  EXPECT_THROW(make_source_size(nullptr, {{{}, {}, 1, 1, -1, 1}}), InputError);
  EXPECT_THROW(make_source_size(nullptr, {{{NAN, 0, 0}, {}, 1, 1, 0, 1}}), InputError);
}

TEST(BoundarySize, UniformBoundaryGivesItsLength) {
  const auto patch = shapes::rectangle(1, 1, 10, 10, 0.3);
  const auto size = make_boundary_size(background_of(patch), line_mesh(patch));
  const auto background = background_of(patch);
  std::mt19937_64 random(1);
  for (int i = 0; i < 200; ++i) {
    const Vec2 u = random_point(background->triangles(), random);
    EXPECT_NEAR(at(*size, u.x, u.y), 0.1, 1e-12);
  }
}

TEST(BoundarySize, AnnulusIsAPowerOfTheRadius) {
  const auto patch = shapes::annulus(0.2, 1, 100, 100);
  const auto size = make_boundary_size(background_of(patch), line_mesh(patch));
  const double inner = 2 * 0.2 * std::sin(M_PI / 100);
  // log delta is harmonic and equal on each circle: a + b log r, here with b = 1; the triangles are coarse.
  for (const double r : {0.21, 0.3, 0.5, 0.9}) {
    for (const double t : {0.1, 1.7, 4.0}) {
      EXPECT_NEAR(at(*size, r * std::cos(t), r * std::sin(t)), inner * r / 0.2, 0.05 * inner * r / 0.2);
    }
  }
}

TEST(BoundarySize, StaysBetweenTheBoundarysSizes) {
  for (int seed = 0; seed < 20; ++seed) {
    const auto patch = shapes::random_polygon_with_holes(seed);
    const auto background = background_of(patch);
    const auto size = make_boundary_size(background, line_mesh(patch));
    double least = INFINITY, most = 0;
    for (const auto& [i, j] : patch.edges) {
      least = std::min(least, norm(patch.points[j] - patch.points[i]));
      most = std::max(most, norm(patch.points[j] - patch.points[i]));
    }
    std::mt19937_64 random(seed);
    for (int i = 0; i < 100; ++i) {
      const Vec2 u = random_point(background->triangles(), random);
      EXPECT_GE(at(*size, u.x, u.y), 0.99 * least);
      EXPECT_LE(at(*size, u.x, u.y), 1.01 * most);
    }
    // At its nodes it is the mean of the two edges.
    const auto& [a, b] = patch.edges[1];
    const int before = patch.edges[0][0];
    const double mean =
        (norm(patch.points[a] - patch.points[before]) + norm(patch.points[b] - patch.points[a])) / 2;
    EXPECT_NEAR(at(*size, patch.points[a].x, patch.points[a].y), mean, 1e-12);
  }
}

TEST(LimitGradation, AgreesWithBruteForce) {
  const auto background = background_of(shapes::rectangle(1, 1, 5, 5));
  const auto base_at = [](Vec2 u) { return u.x < 0.5 && u.y < 0.5 ? 0.02 + 0.5 * std::abs(u.x - 0.3) : 0.5; };
  const std::shared_ptr<const SizeField> base =
      make_expression_size("x < 0.5 && y < 0.5 ? 0.02 + 0.5*abs(x - 0.3) : 0.5");
  const double slope = 0.2;
  const auto limited = limit_gradation(base, background, slope);
  for (double x = 0.05; x < 1; x += 0.1) {
    for (double y = 0.05; y < 1; y += 0.1) {
      double expected = INFINITY;
      for (int i = 0; i <= 500; ++i) {
        for (int j = 0; j <= 500; ++j) {
          const Vec2 p = {i / 500.0, j / 500.0};
          expected = std::min(expected, base_at(p) + slope * norm(p - Vec2{x, y}));
        }
      }
      EXPECT_NEAR(at(*limited, x, y), expected, 0.05 * expected) << x << ' ' << y;
    }
  }
}

TEST(LimitGradation, LimitsTheSlope) {
  const auto background = background_of(shapes::random_polygon_with_holes(5, 0.1));
  const std::shared_ptr<const SizeField> base = make_expression_size("0.01*(1+30*(y-x^2)^2+(1-x)^2)");
  const auto limited = limit_gradation(base, background, 0.3);
  std::mt19937_64 random(2);
  int steep = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec2 a = random_point(background->triangles(), random);
    const Vec2 b = a + 0.05 * Vec2{shapes::uniform(random) - 0.5, shapes::uniform(random) - 0.5};
    const double difference = std::abs(at(*limited, a.x, a.y) - at(*limited, b.x, b.y));
    const double allowed = 0.3 * norm(b - a);
    EXPECT_LE(difference, allowed + 0.05 * at(*limited, a.x, a.y));  // samples are a tenth apart in size
    EXPECT_LE(at(*limited, a.x, a.y), at(*base, a.x, a.y));
    steep += std::abs(at(*base, a.x, a.y) - at(*base, b.x, b.y)) > 2 * allowed;
  }
  EXPECT_GT(steep, 50);
}

TEST(LimitGradation, LeavesGentleFieldsAlone) {
  const auto background = background_of(shapes::rectangle(1, 1, 5, 5));
  const std::shared_ptr<const SizeField> base = make_expression_size("0.1 + 0.2*x");
  const auto limited = limit_gradation(base, background, 0.3);
  for (double x = 0.05; x < 1; x += 0.1) EXPECT_EQ(at(*limited, x, 0.4), at(*base, x, 0.4));
  EXPECT_THROW(limit_gradation(base, background, 0), InputError);
}

}  // namespace
}  // namespace delquad
