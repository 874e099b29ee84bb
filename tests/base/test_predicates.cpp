// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"

namespace delquad {
namespace {

TEST(Predicates, SimpleSigns) {
  EXPECT_EQ(orient2d({0, 0}, {1, 0}, {0, 1}), 1);
  EXPECT_EQ(orient2d({0, 0}, {0, 1}, {1, 0}), -1);
  EXPECT_EQ(in_circle({0, 0}, {1, 0}, {0, 1}, {0.5, 0.5}), 1);
  EXPECT_EQ(in_circle({0, 0}, {1, 0}, {0, 1}, {1, 1}), 0);
  EXPECT_EQ(in_circle({0, 0}, {1, 0}, {0, 1}, {2, 2}), -1);
}

// Points a few units in the last place off a line. Floating-point determinants get most of these signs wrong.
// The exact sign is the sign of the integer determinant in units of the last place.
TEST(Predicates, OrientationNextToALineIsExact) {
  const double unit = std::ldexp(1.0, -53);
  int wrong_in_floating_point = 0;
  for (int i = 0; i < 64; ++i) {
    for (int j = 0; j < 64; ++j) {
      const Vec2 a{0.5 + i * unit, 0.5 + j * unit}, b{12, 12}, c{24, 24};
      // a, b, c: the area has the sign of (x - y) of a's offset, as b and c lie on the diagonal.
      const int expected = (i < j) - (i > j);
      EXPECT_EQ(orient2d(b, c, a), expected) << i << " " << j;
      const double det = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
      wrong_in_floating_point += ((det > 0) - (det < 0)) != expected;
    }
  }
  EXPECT_GT(wrong_in_floating_point, 0) << "the test is too easy";
}

TEST(Predicates, CocircularLatticeIsExact) {
  // The corners of any integer square, scaled by a power of two, are cocircular exactly.
  for (int x = -7; x < 8; ++x) {
    for (int y = 1; y < 8; ++y) {
      const double s = std::ldexp(1.0, -20);
      const Vec2 o{1e3, -3e2}, a = o, b = o + s * Vec2{double(x), double(y)};
      const Vec2 c = b + s * Vec2{double(-y), double(x)}, d = o + s * Vec2{double(-y), double(x)};
      EXPECT_EQ(in_circle(a, b, c, d), 0);
      // Moved by the last bit towards the center and away from it.
      const Vec2 centre = 0.5 * (a + c), step = {std::copysign(std::ldexp(1.0, -43), centre.x - d.x), 0};
      if (centre.x == d.x) continue;
      EXPECT_EQ(in_circle(a, b, c, d + step), 1) << x << " " << y;
      EXPECT_EQ(in_circle(a, b, c, d - step), -1) << x << " " << y;
    }
  }
}

TEST(Predicates, TinyCoordinatesDoNotUnderflow) {
  const double s = 1e-170;
  EXPECT_EQ(orient2d({0, 0}, {s, 0}, {0, s}), 1);
  EXPECT_EQ(in_circle({0, 0}, {s, 0}, {0, s}, {0.4 * s, 0.4 * s}), 1);
  EXPECT_EQ(in_circle({0, 0}, {s, 0}, {0, s}, {s, s}), 0);
}

}  // namespace
}  // namespace delquad
