// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/curves/mesh_planar_curves.h"
#include "geometry/planar/loops_apart.h"
#include "tests/geometry/planar/models.h"

namespace delquad {
namespace {

/// A square from (-10, -10) to (10, 10) with two circles in it.
PlanarModel two_circles(Vec2 a, double ra, Vec2 b, double rb) {
  return ModelMaker()
      .loop(rectangle_sides(-10, -10, 10, 10))
      .loop({make_circle(a, ra)})
      .loop({make_circle(b, rb)});
}

void expect_touching(const PlanarModel& model, double size, const std::string& where) {
  SCOPED_TRACE(size);
  expect_input_error([&] { make_domain(model, constant(size)); }, {("touch at " + where).c_str()});
}

TEST(LoopsApart, CirclesThatTouchAreRefusedWhateverTheirNodes) {
  // Touching at a node of both, of one, and of none.
  for (const double size : {1.0, 0.3, 0.07}) {
    expect_touching(two_circles({-2, 0}, 2 + 1e-9, {3, 0}, 3), size, "(");
    expect_touching(two_circles({-1.2, -1.6}, 2, {1.8, 2.4}, 3), size, "(");
    const double third = std::numbers::pi / 3 + 0.1;
    const Vec2 direction{std::cos(third), std::sin(third)};
    expect_touching(two_circles({0, 0}, 2, 5 * direction, 3 - 1e-7), size, "(");
  }
}

TEST(LoopsApart, CircleThatTouchesOrCrossesAWall) {
  for (const double size : {1.0, 0.3}) {
    expect_touching(two_circles({1.3, 8}, 2, {0, 0}, 0.5), size, "(1.");
    // Its edges stay inside.
    expect_touching(two_circles({1.3, 8}, 2.001, {0, 0}, 0.5), size, "(1.");
  }
}

TEST(LoopsApart, CloseIsNotTouching) {
  for (const double size : {1.0, 0.3, 0.05}) {
    EXPECT_EQ(make_domain(two_circles({-2, 0}, 2, {3, 0}, 3 - 1e-3), constant(size)).patches.size(), 1u);
    EXPECT_EQ(make_domain(two_circles({1.3, 8}, 2 - 1e-4, {0, 0}, 0.5), constant(size)).patches.size(), 1u);
  }
  // Everywhere close.
  const PlanarModel ring = ModelMaker().loop({make_circle({0, 0}, 1)}).loop({make_circle({0, 0}, 1 - 1e-4)});
  EXPECT_EQ(make_domain(ring, constant(0.01)).patches.size(), 1u);
}

TEST(LoopsApart, ManyLoopsTakeNoTimeOfPairs) {
  ModelMaker builder;
  builder.loop(rectangle_sides(-1, -1, 100, 100));
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 40; ++j) builder.loop({make_circle({2.0 * i + 1, 2.0 * j + 1}, 0.99)});
  EXPECT_EQ(make_domain(builder, constant(0.1)).patches.size(), 1u);
}

}  // namespace
}  // namespace delquad
