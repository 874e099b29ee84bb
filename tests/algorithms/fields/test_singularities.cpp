// SPDX-License-Identifier: GPL-3.0-or-later
#include <complex>
#include "algorithms/fields/singularities.h"
#include "tests/algorithms/fields/backgrounds.h"

namespace delquad {
namespace {

using Complex = std::complex<double>;

/// The singularities of z(u) taken at the middles of the sides of a square's background mesh.
std::vector<Singularity> singularities_of(const BackgroundMesh& background,
                                          const std::function<Complex(Complex)>& z) {
  const TriPatch& tri = background.triangles();
  const Sides sides = number_sides(tri);
  std::vector<Cross> crosses(sides.count);
  for (std::size_t t = 0; t < tri.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const Vec2 m =
          0.5 * (tri.points[tri.triangles[t][(k + 1) % 3]] + tri.points[tri.triangles[t][(k + 2) % 3]]);
      const Complex value = z({m.x, m.y});
      crosses[sides.of_triangle[t][k]] = {value.real(), value.imag()};
    }
  }
  return find_singularities(background, sides, crosses, find_winding(background, sides, crosses))
      .singularities;
}

constexpr Complex kP = {0.31, 0.42}, kQ = {0.71, 0.63};

TEST(Singularities, AreFoundWhereTheFieldVanishes) {
  const auto background = background_of(shapes::rectangle(1, 1, 30, 30));
  const auto one = singularities_of(*background, [](Complex u) { return u - kP; });
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0].index, 1);
  EXPECT_NEAR(one[0].at.x, kP.real(), 0.1);  // the background's triangles are about that large
  EXPECT_NEAR(one[0].at.y, kP.imag(), 0.1);

  const auto opposite = singularities_of(*background, [](Complex u) { return std::conj(u - kP); });
  ASSERT_EQ(opposite.size(), 1u);
  EXPECT_EQ(opposite[0].index, -1);

  const auto both = singularities_of(*background, [](Complex u) { return (u - kP) * std::conj(u - kQ); });
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(both[0].index + both[1].index, 0);
}

TEST(Singularities, OppositeNeighboursCancel) {
  const auto background = background_of(shapes::rectangle(1, 1, 30, 30));
  const Complex near = kP + Complex{0.02, 0.01};
  EXPECT_TRUE(
      singularities_of(*background, [near](Complex u) { return (u - kP) * std::conj(u - near); }).empty());
  int index = 0;
  for (const auto& s : singularities_of(*background, [near](Complex u) { return (u - kP) * (u - near); })) {
    index += s.index;
  }
  EXPECT_EQ(index, 2);
}

TEST(Singularities, NoneWithoutTurning) {
  const auto background = background_of(shapes::rectangle(1, 1, 30, 30));
  EXPECT_TRUE(singularities_of(*background, [](Complex) { return Complex{-1, 0}; }).empty());
  EXPECT_TRUE(singularities_of(*background, [](Complex u) {
                return std::exp(Complex{0, 3} * u.real());
              }).empty());
}

}  // namespace
}  // namespace delquad
