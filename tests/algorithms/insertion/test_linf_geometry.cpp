// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/insertion/linf_geometry.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

constexpr double kPi = std::numbers::pi;
// A dozen operations on numbers of order one.
constexpr double kRounding = 1e-13;

/// A circumsquare: |x - center| = radius in the norm for all three vertices.
struct Circumsquare {
  Vec2 centre;
  double radius = std::numeric_limits<double>::infinity();
};

/// The case in which the box is at least as wide as high; coordinates are (along the wide side, across).
Circumsquare wide_circumsquare(std::array<Vec2, 3> v) {
  std::sort(v.begin(), v.end(), [](Vec2 a, Vec2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  const double width = v[2].x - v[0].x;
  const auto [low, high] = std::minmax({v[0].y, v[1].y, v[2].y});
  Circumsquare square{{(v[0].x + v[2].x) / 2, (low + high) / 2}, width / 2};
  if (v[1].x == v[0].x || v[1].x == v[2].x) return square;  // all three lie on the left and right sides
  if (v[1].y == high) {
    square.centre.y = high - width / 2;
  } else if (v[1].y == low) {
    square.centre.y = low + width / 2;
  } else {
    square.radius =
        std::numeric_limits<double>::infinity();  // the middle one is inside the box of the others
  }
  return square;
}

/// The smallest square through the three vertices with sides along the frame [section 4.4]; where several
/// centers serve (Figure 11), the one in the middle. An infinite radius when there is no such square.
Circumsquare circumsquare(const std::array<Vec2, 3>& triangle, const Frame& frame) {
  std::array<Vec2, 3> wide, high;
  for (int k = 0; k < 3; ++k) {
    wide[k] = frame.to_local(triangle[k]);
    high[k] = {wide[k].y, wide[k].x};
  }
  const auto [x0, x1] = std::minmax({wide[0].x, wide[1].x, wide[2].x});
  const auto [y0, y1] = std::minmax({wide[0].y, wide[1].y, wide[2].y});
  Circumsquare square;
  if (x1 - x0 >= y1 - y0) square = wide_circumsquare(wide);
  if (y1 - y0 > x1 - x0 || (y1 - y0 == x1 - x0 && std::isinf(square.radius))) {
    square = wide_circumsquare(high);
    std::swap(square.centre.x, square.centre.y);
  }
  square.centre = frame.to_global(square.centre);
  return square;
}

struct RandomEdge {
  Vec2 p, q;
  Frame axes;
};

/// Random edges in random frames; every fourth is aligned with an axis, every fourth with a diagonal, up to
/// rounding.
RandomEdge random_edge(std::mt19937_64& random, int kind) {
  const double theta = 2 * kPi * shapes::uniform(random);
  double direction = 2 * kPi * shapes::uniform(random);
  if (kind % 4 == 0) direction = theta + (random() % 4) * kPi / 2;
  if (kind % 4 == 1) direction = theta + kPi / 4 + (random() % 4) * kPi / 2;
  const Vec2 middle{2 * shapes::uniform(random) - 1, 2 * shapes::uniform(random) - 1};
  const Vec2 half = (0.1 + shapes::uniform(random)) * Vec2{std::cos(direction), std::sin(direction)};
  return {middle - half, middle + half, Frame::from_angle(theta)};
}

/// Random edges, none of them aligned, each with a point on its left (side 1) or right (-1).
std::vector<std::pair<CanonicalEdge, Vec2>> random_triangles(int seed, int side) {
  std::mt19937_64 random(seed);
  std::vector<std::pair<CanonicalEdge, Vec2>> triangles;
  for (int i = 0; i < 20000; ++i) {
    const RandomEdge r = random_edge(random, 2 + i % 2);
    const CanonicalEdge e(r.p, r.q, r.axes);
    const Vec2 point{3 * shapes::uniform(random) - 1.5, side * 3 * shapes::uniform(random)};
    if (side * cross({e.alpha, e.beta}, point) > 0) triangles.emplace_back(e, point);
  }
  return triangles;
}

double distance(const Frame& axes, Vec2 a, Vec2 b) { return linf_norm(axes.to_local(b - a)); }

TEST(LinfGeometry, NormAndExtentOfHalfASquare) {
  EXPECT_EQ(linf_norm({-3, 2}), 3);
  EXPECT_EQ(linf_norm({1, -5}), 5);
  EXPECT_EQ(linf_extent({Vec2{0, 0}, Vec2{1, 0}, Vec2{0, 1}}, {}), 1);
  EXPECT_NEAR(linf_extent({Vec2{0, 0}, Vec2{1, 0}, Vec2{0, 1}}, Frame::from_angle(kPi / 4)),
              std::numbers::sqrt2, kRounding);
}

TEST(LinfGeometry, FrameFromCrossHalvesTheAngle) {
  for (int i = -1000; i <= 1000; ++i) {
    const double theta = i * kPi / 4000;  // within (-pi/4, pi/4)
    const Frame frame = Frame::from_cross(Cross::from_angle(theta)), exact = Frame::from_angle(theta);
    EXPECT_NEAR(norm(frame.e1 - exact.e1), 0, 1e-15) << theta;
    EXPECT_NEAR(norm(frame.e2 - exact.e2), 0, 1e-15) << theta;
  }
  EXPECT_EQ(Frame::from_cross({0, 0}).e1, (Vec2{1, 0}));
}

TEST(LinfGeometry, BisectorPointsAreAtDistanceRhoFromBothEndsOnTheLeft) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 20000; ++i) {
    const RandomEdge r = random_edge(random, i);
    const CanonicalEdge e(r.p, r.q, r.axes);
    EXPECT_GT(e.alpha, 0);
    EXPECT_LE(std::abs(e.beta), e.alpha * (1 + kRounding));
    EXPECT_NEAR(e.length(), distance(r.axes, r.p, r.q), kRounding);
    const double rho = e.alpha * (1 + 3 * shapes::uniform(random));
    const Vec2 x = e.to_global(bisector_point(e, rho));
    EXPECT_NEAR(distance(r.axes, x, r.p), rho, kRounding);
    EXPECT_NEAR(distance(r.axes, x, r.q), rho, kRounding);
    EXPECT_GT(cross(r.q - r.p, x - r.p), -kRounding);
  }
}

TEST(LinfGeometry, EquilateralApexMakesHalfASquareOfAlignedAndDiagonalEdges) {
  // [section 4.3]: all three sides have the same length in the norm.
  std::mt19937_64 random(2);
  for (int i = 0; i < 2000; ++i) {
    const RandomEdge r = random_edge(random, i);
    const CanonicalEdge e(r.p, r.q, r.axes);
    const Vec2 apex = e.to_global(bisector_point(e, e.length()));
    EXPECT_NEAR(distance(r.axes, apex, r.p), e.length(), kRounding);
    EXPECT_NEAR(distance(r.axes, apex, r.q), e.length(), kRounding);
    EXPECT_NEAR(linf_extent({r.p, r.q, apex}, r.axes), e.length(), kRounding);
    if (i % 4 > 1) continue;
    const Vec2 a = r.p - apex, b = r.q - apex, c = r.q - r.p;
    const double sides[3] = {dot(a, a), dot(b, b), dot(c, c)};
    const double longest = std::max({sides[0], sides[1], sides[2]});
    EXPECT_NEAR(sides[0] + sides[1] + sides[2], 2 * longest, 1e-11) << "not a right triangle";
  }
}

/// Smallest R such that some square of half width R has all three points on its outline. By brute force over
/// the centers that the outline condition allows: with R given, each point lies on one of four sides.
double brute_force_circumradius(const std::array<Vec2, 3>& v) {
  double best = INFINITY;
  // A square is fixed by which side each vertex lies on: vertical sides fix cx -+ R, horizontal ones cy -+ R.
  for (int code = 0; code < 64; ++code) {
    double lo_x = NAN, hi_x = NAN, lo_y = NAN, hi_y = NAN;
    bool consistent = true;
    const auto set = [&](double& slot, double value) {
      if (!std::isnan(slot) && std::abs(slot - value) > 1e-12) consistent = false;
      slot = value;
    };
    for (int k = 0; k < 3; ++k) {
      const int side = (code >> (2 * k)) & 3;
      if (side == 0) set(lo_x, v[k].x);
      if (side == 1) set(hi_x, v[k].x);
      if (side == 2) set(lo_y, v[k].y);
      if (side == 3) set(hi_y, v[k].y);
    }
    if (!consistent) continue;
    const double width = hi_x - lo_x, height = hi_y - lo_y;
    const double size =
        !std::isnan(width) ? width : height;  // three sides fix the square when two are opposite
    if (std::isnan(size) || size <= 0 || (!std::isnan(width) && !std::isnan(height))) continue;
    const auto inside = [&](double lo, double hi, double x) { return x >= lo - 1e-12 && x <= hi + 1e-12; };
    const auto fits = [&](double lo, double hi, auto coordinate) {
      if (std::isnan(lo) && std::isnan(hi)) {  // free: slide so that all are inside, if they fit
        double a = INFINITY, b = -INFINITY;
        for (const Vec2 p : v) a = std::min(a, coordinate(p)), b = std::max(b, coordinate(p));
        return b - a <= size + 1e-12;
      }
      if (std::isnan(lo)) lo = hi - size;
      for (const Vec2 p : v) {
        if (!inside(lo, lo + size, coordinate(p))) return false;
      }
      return true;
    };
    if (fits(lo_x, hi_x, [](Vec2 p) { return p.x; }) && fits(lo_y, hi_y, [](Vec2 p) { return p.y; })) {
      best = std::min(best, size / 2);
    }
  }
  return best;
}

TEST(LinfGeometry, CircumsquareAgreesWithBruteForce) {
  std::mt19937_64 random(3);
  int with = 0, without = 0;
  for (int i = 0; i < 5000; ++i) {
    std::array<Vec2, 3> v;
    for (Vec2& p : v) p = {shapes::uniform(random), shapes::uniform(random)};
    if (i % 5 == 0) v[1].x = v[0].x;                 // a side along an axis
    if (i % 10 == 0) v[2] = {v[0].x + 0.5, v[0].y};  // a right angle, legs along the axes
    const Frame frame = Frame::from_angle(i % 2 ? 2 * kPi * shapes::uniform(random) : 0);
    std::array<Vec2, 3> rotated;
    for (int k = 0; k < 3; ++k) rotated[k] = frame.to_global(v[k]);
    const Circumsquare square = circumsquare(rotated, frame);
    const double expected = brute_force_circumradius(v);
    if (std::isinf(expected) && std::isinf(square.radius)) {
      ++without;
      continue;
    }
    ++with;
    // A rotated right angle is one only up to rounding: then the circumsquare of the rounded triangle may not
    // exist.
    if (i % 5 == 0 && i % 2 && std::isinf(square.radius)) continue;
    ASSERT_NEAR(square.radius, expected, 1e-11) << i;
    EXPECT_NEAR(2 * square.radius, linf_extent(rotated, frame), 1e-11);
    for (const Vec2 p : rotated) EXPECT_NEAR(distance(frame, square.centre, p), square.radius, 1e-11) << i;
  }
  EXPECT_GT(with, 1000);
  EXPECT_GT(without, 1000);
}

// The center that circumradius_on_branch speaks of is on the bisector and at that distance from the apex too.
TEST(LinfGeometry, CircumradiusOnTheBranchIsThatOfASquareThroughTheApex) {
  int on_branch = 0;
  for (const auto& [e, apex] : random_triangles(4, 1)) {
    const double rho = circumradius_on_branch(e, apex);
    if (std::isinf(rho) || rho < e.alpha) continue;
    ++on_branch;
    const Vec2 centre = bisector_point(e, rho);
    EXPECT_NEAR(linf_norm(apex - centre), rho, kRounding);
  }
  EXPECT_GT(on_branch, 2000);
}

TEST(LinfDelquad, CompletesSquaresOverAlignedAndDiagonalEdges) {
  const auto strategy = make_linf_delquad();
  // Over an aligned edge: straight above one of its ends.
  const FrontEdge aligned{{0, 0}, {1, 0}, {0.4, 3}, {}, 1, {}};
  EXPECT_EQ(strategy->candidates(aligned).points[0], (Vec2{0, 1}));
  EXPECT_EQ(strategy->candidates(aligned).points[1], (Vec2{1, 1}));
  // Over a hypotenuse: the fourth corner.
  const FrontEdge diagonal{{1, 0}, {0, 1}, {-3, -3}, {}, 1, {}};
  const Vec2 corner = strategy->candidates(diagonal).points[0];
  EXPECT_NEAR(norm(corner), 0, kRounding);
}

TEST(L2Frontal, MakesEquilateralTriangles) {
  const auto strategy = make_l2_frontal();
  const FrontEdge edge{{0, 0}, {1, 0}, {0.5, 4}, {}, 1, {}};
  const Vec2 x = strategy->candidates(edge).points[0];
  EXPECT_NEAR(norm(x - Vec2{0.5, std::numbers::sqrt3 / 2}), 0, kRounding);
  EXPECT_NEAR(strategy->triangle_size({edge.p, edge.q, x}, {}, 1), 1, kRounding);
}

}  // namespace
}  // namespace delquad
