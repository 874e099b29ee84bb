// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/algorithms/fields/backgrounds.h"

namespace delquad {
namespace {

PatchBoundary lewis_domain() {
  return shapes::polygon({{-1.25, -0.5}, {1.25, -0.5}, {1.25, 1.25}, {-1.25, 1.25}});
}

double count(const PatchBoundary& patch, const std::string& size, double relative_error = 0.01) {
  return expected_quads(background_of(patch)->triangles(), *make_expression_size(size), relative_error);
}

TEST(ExpectedQuads, ConstantSizeIsAreaOverItsSquare) {
  const auto patch = shapes::l_shape(3);
  EXPECT_NEAR(expected_quads(background_of(patch)->triangles(), *make_constant_size(0.01)), 30000, 1e-6);
}

TEST(ExpectedQuads, ClosedForm) {
  // Integral of 1 / (0.01 exp(x))^2 over the unit square.
  const double exact = 1e4 * (1 - std::exp(-2.0)) / 2;
  EXPECT_NEAR(count(shapes::rectangle(1, 1, 1, 1), "0.01 * exp(x)", 1e-6), exact, 1e-6 * exact);
}

// Reference values by independent numerical integration.
TEST(ExpectedQuads, LewisField) {
  EXPECT_NEAR(count(lewis_domain(), "0.01*(1+30*(y-x^2)^2+(1-x)^2)"), 2887, 0.01 * 2887);
  EXPECT_NEAR(count(lewis_domain(), "0.01*(1+30*(x-y^2)^2+(1-x)^2)"), 2567, 0.01 * 2567);
}

TEST(ExpectedQuads, SeesANarrowValley) {
  // Across the valley the integral of 1 / (d + |s|)^2 is 2 (1/d - 1/(d + 1)), with d = 0.001 (of the domain's
  // 2).
  const double d = 0.001, exact = 2 * (1 / d - 1 / (d + 1));
  EXPECT_NEAR(count(shapes::polygon({{-1, 0}, {1, 0}, {1, 1}, {-1, 1}}), "0.001 + abs(x)"), exact,
              0.01 * exact);
}

TEST(ExpectedQuads, SeesASmallSource) {
  const auto size =
      make_source_size(make_constant_size(0.1), {{{0.3, 0.3, 0}, {0.3, 0.3, 0}, 1e-4, 0.1, 0.005, 0.1}});
  const double pi = std::numbers::pi, r0 = 0.005, r1 = 0.1, d0 = 1e-4, d1 = 0.1,
               slope = (d1 - d0) / (r1 - r0);
  // Integral of 2 pi r dr / delta^2 over the ring, with r = (delta - d0) / slope + r0.
  const double ring = 2 * pi / slope * ((std::log(d1 / d0)) / slope + (r0 - d0 / slope) * (1 / d0 - 1 / d1));
  const double exact = pi * r0 * r0 / (d0 * d0) + ring + (1 - pi * r1 * r1) / (d1 * d1);
  EXPECT_NEAR(expected_quads(background_of(shapes::rectangle(1, 1, 1, 1))->triangles(), *size), exact,
              0.01 * exact);
}

class Counting final : public SizeField {
 public:
  explicit Counting(std::shared_ptr<const SizeField> size) : size_(std::move(size)) {}
  double at(const Vec3& x, int& hint) const override { return ++n, size_->at(x, hint); }
  mutable int n = 0;

 private:
  std::shared_ptr<const SizeField> size_;
};

/// Edges of a curve make slivers up to the far boundary.
TEST(ExpectedQuads, LooksAtSliversWhereTheyAreFine) {
  PatchBoundary strip;
  shapes::add_polygon(strip, {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {400, 1, 1, 1});
  const Counting size(make_expression_size("0.002 + 0.3 * y"));
  const double d = 0.002, g = 0.3, exact = (1 / d - 1 / (d + g)) / g;
  EXPECT_NEAR(expected_quads(background_of(strip)->triangles(), size, 0.1), exact, 0.1 * exact);
  EXPECT_LT(size.n, 200'000);
}

TEST(ExpectedQuads, EndsWhereTheIntegralDoesNot) {
  const double diverges =
      count(shapes::polygon({{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}), "1e-200 + x^2 + y^2", 1e-9);
  EXPECT_GT(diverges, 1e6);
  EXPECT_THROW(count(shapes::rectangle(1, 1, 1, 1), "x - 0.2"), InputError);
}

}  // namespace
}  // namespace delquad
