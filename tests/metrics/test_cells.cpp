// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/cells.h"

#include "tests/support/cells.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

TEST(Cells, AreMeasuredByShape) {
  const CellMeasures all = measure(mixed_solid());
  ASSERT_EQ(all.shapes.size(), 4u);
  const std::size_t counts[] = {1, 2, 5, 2};
  const double volumes[] = {1, 1, 5.0 / 6, 1.0 / 6};
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(all.shapes[k].count, counts[k]) << all.shapes[k].name;
    EXPECT_NEAR(all.shapes[k].volume, volumes[k], 1e-15) << all.shapes[k].name;
    EXPECT_GT(all.shapes[k].least_jacobian, 0) << all.shapes[k].name;
  }
  EXPECT_EQ(all.count, 10u);
  EXPECT_NEAR(all.volume, 3, 1e-14);
  EXPECT_EQ(all.unproven, 0);
  EXPECT_EQ(all.jacobian.size(), 10u);
  EXPECT_EQ(all.least_jacobian, *std::ranges::min_element(all.jacobian));
}

TEST(Cells, WithEdgesOfOneLengthHaveJacobianOne) {
  const double s = std::sqrt(0.75), t = s / 3, h = std::sqrt(2.0 / 3);
  EXPECT_NEAR(scaled_jacobian(std::array<Vec3, 4>{{{0, 0, 0}, {1, 0, 0}, {0.5, s, 0}, {0.5, t, h}}}), 1,
              1e-15);
  EXPECT_NEAR(scaled_jacobian(std::array<Vec3, 5>{
                  {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, std::sqrt(0.5)}}}),
              1, 1e-15);
  EXPECT_NEAR(scaled_jacobian(std::array<Vec3, 6>{
                  {{0, 0, 0}, {1, 0, 0}, {0.5, s, 0}, {0, 0, 1}, {1, 0, 1}, {0.5, s, 1}}}),
              1, 1e-15);
}

double number(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53 - 0.5; }

/// A point of the map of a prism or pyramid.
Vec3 place(std::span<const Vec3> p, double u, double v, double w) {
  if (p.size() == 6)
    return (1 - w) * (p[0] + u * (p[1] - p[0]) + v * (p[2] - p[0])) +
           w * (p[3] + u * (p[4] - p[3]) + v * (p[5] - p[3]));
  const Vec3 base = (1 - v) * ((1 - u) * p[0] + u * p[1]) + v * ((1 - u) * p[3] + u * p[2]);
  return (1 - w) * base + w * p[4];
}

/// Least Jacobian of samples, and the volume by the mean of samples in the middle of cells.
template <std::size_t N>
void compare_with_samples(const std::array<Vec3, N>& cell) {
  std::mt19937_64 random(7);
  int proven = 0, between = 0;
  for (int k = 0; k < 300; ++k) {
    std::array<Vec3, N> at = cell;
    for (Vec3& p : at) p = p + 0.9 * Vec3{number(random), number(random), number(random)};
    double least = 1e9, volume = 0;
    constexpr int kSamples = 12;
    constexpr double kStep = 1e-5;
    for (int i = 0; i < kSamples; ++i)
      for (int j = 0; j < kSamples; ++j)
        for (int l = 0; l < kSamples; ++l) {
          double u = (i + 0.5) / kSamples, v = (j + 0.5) / kSamples, w = (l + 0.5) / kSamples;
          if (N == 6 && u + v > 1) u = 1 - u, v = 1 - v;
          const auto slope = [&](double a, double b, double c) {
            return 0.5 / kStep * (place(at, u + a, v + b, w + c) - place(at, u - a, v - b, w - c));
          };
          const double jacobian = dot(cross(slope(kStep, 0, 0), slope(0, kStep, 0)), slope(0, 0, kStep));
          least = std::min(least, jacobian);
          volume += jacobian * (N == 6 ? 0.5 : 1) / (kSamples * kSamples * kSamples);
        }
    EXPECT_NEAR(signed_volume(at), volume, 2e-2 * std::abs(volume) + 2e-3);
    const bool positive = is_positive(at);
    EXPECT_TRUE(!positive || least > 0);
    proven += positive;
    between += !positive && least > 0.02;
  }
  EXPECT_GT(proven, 50);
  EXPECT_LT(between, 10);  // whose corners samples do not reach
}

TEST(Cells, AreProvenPositiveWhereSamplesAre) {
  compare_with_samples<6>({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}}});
  compare_with_samples<5>({{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}}});
}

TEST(Cells, ThatAreInvertedInTheMiddleAreNotPositive) {
  // The second triangle is the first one times s and t. Between them one side, then the other turns round.
  const auto prism = [](double s, double t) {
    return std::array<Vec3, 6>{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {s, 0, 1}, {0, t, 1}}};
  };
  EXPECT_TRUE(is_positive(prism(4, 0.25)));
  EXPECT_GT(scaled_jacobian(prism(-4, -0.25)), 0);
  EXPECT_FALSE(is_positive(prism(-4, -0.25)));
}

TEST(Soundness, OfAMixedMeshIsProven) {
  EXPECT_EQ(defects_of_cells(mixed_solid()), std::vector<std::string>());
}

/// A change that makes a mesh unsound, and a part of what is said about it.
struct Mutation {
  const char* what;
  std::function<void(Mesh&)> change;
  std::string part;
};

TEST(Soundness, IsDeniedToEveryMutation) {
  const auto swap = [](auto& cell, int a, int b) { std::swap(cell[a], cell[b]); };
  const Mutation all[] = {
      {"a number that is no point's", [](Mesh& m) { m.tetrahedra[0][2] = 99; }, "there are"},
      {"a place that is no number", [](Mesh& m) { m.points[0].x = std::numeric_limits<double>::quiet_NaN(); },
       "finite"},
      {"a corner twice", [](Mesh& m) { m.pyramids[0][4] = m.pyramids[0][0]; },
       "pyramids with a corner twice"},
      {"an inverted cell",
       [](Mesh& m) {
         m.points[m.pyramids[0][4]] = {0.9, 0.5, 0.5};
       },
       "pyramids that are not proven to be positive: 1"},
      {"a cell turned inside out", [&](Mesh& m) { swap(m.tetrahedra[0], 0, 1); }, "other orders of corners"},
      {"a twisted hexahedron", [&](Mesh& m) { swap(m.hexahedra[0], 4, 5); }, "hexahedra that are not proven"},
      {"a missing cell",
       [](Mesh& m) {
         m.pyramids.erase(m.pyramids.begin());
         m.pyramid_volume.pop_back();
       },
       "sides of one cell that are no faces of the mesh"},
      {"a cell twice",
       [](Mesh& m) {
         m.prisms.push_back(m.prisms[0]);
         m.prism_volume.push_back(0);
       },
       "sides of three cells"},
      {"two tetrahedra in the place of a pyramid on a hexahedron",
       [](Mesh& m) {
         const std::array<int, 5> v = m.pyramids[4];
         m.pyramids.erase(m.pyramids.begin() + 4);
         m.pyramid_volume.pop_back();
         for (const auto& t : {std::array{v[0], v[1], v[2], v[4]}, std::array{v[0], v[2], v[3], v[4]}}) {
           m.tetrahedra.push_back(t);
           m.tet_volume.push_back(0);
         }
         m.triangles.clear();
         m.triangle_region.clear();
         m.quads.clear();
         m.quad_region.clear();
         testing_support::add_skin(m, [](const Mesh&, const auto&) { return 0; });
       },
       "triangles that meet a quad: 2"},
      {"a crack",
       [](Mesh& m) {
         m.points.push_back(m.points[m.prisms[0][0]]);
         for (auto& v : m.prisms) std::ranges::replace(v, v[0], static_cast<int>(m.points.size()) - 1);
       },
       "sides of one cell that are no faces of the mesh"},
      {"a missing face", [](Mesh& m) { m.quads.pop_back(), m.quad_region.pop_back(); },
       "sides of one cell that are no faces of the mesh: 1"},
      {"a face that looks inwards", [](Mesh& m) { std::ranges::reverse(m.quads[0]); },
       "do not look outwards: 1"},
      {"a face of other corners", [](Mesh& m) { m.quads[0][0] = m.prisms[1][2]; }, "no sides of cells"},
      {"a face twice", [](Mesh& m) { m.triangles.push_back(m.triangles[0]), m.triangle_region.push_back(0); },
       "there twice: 1"},
  };
  for (const auto& [what, change, part] : all) {
    Mesh mesh = mixed_solid();
    change(mesh);
    std::string text;
    for (const std::string& line : defects_of_cells(mesh)) text += line + '\n';
    EXPECT_NE(text.find(part), std::string::npos) << what << ": " << text;
  }
}

}  // namespace
}  // namespace delquad
