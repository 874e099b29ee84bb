// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/model_curvature.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

/// Curvature of face 0 at each fine point, over what it should be.
std::vector<double> ratios(const SurfaceModel& model, const std::function<double(const Vec3&)>& exact) {
  const ModelCurvature curvature(model);
  std::vector<double> result;
  for (const Vec3& p : model.fine.points) result.push_back(curvature.of_face(0, p) / exact(p));
  std::ranges::sort(result);
  return result;
}

TEST(ModelCurvature, OfASphereIsOneOverItsRadius) {
  const auto r = ratios(round_sphere(16), [](const Vec3&) { return 1.0; });
  EXPECT_GT(r.front(), 0.85);  // around the corners of the cube it was made from
  EXPECT_LT(r.back(), 1.15);
}

TEST(ModelCurvature, OfACylinderAndOfLongStripsOfOne) {
  for (const int n_along : {10, 1}) {
    const auto r = ratios(cylinder(32, n_along, 0.5, 3), [](const Vec3&) { return 2.0; });
    EXPECT_GT(r.front(), 0.9) << n_along;
    EXPECT_LT(r.back(), 1.1) << n_along;
  }
}

TEST(ModelCurvature, OfATorusIsThatOfItsTube) {
  const auto r = ratios(torus(64, 32, 1, 0.4), [](const Vec3&) { return 2.5; });
  EXPECT_GT(r.front(), 0.85);
  EXPECT_LT(r.back(), 1.15);
}

TEST(ModelCurvature, OfAPlaneIsZeroAlsoBesideABend) {
  // A plane, a quarter of a tube of radius 0.1 in six strips, a plane: one face.
  const double r = 0.1;
  const SurfaceModel model = grid_surface({8, 4}, [&](double u, double v) {
    const int i = static_cast<int>(std::lround(8 * u));
    if (i == 0) return Vec3{-1, v, 0};
    if (i == 8) return Vec3{r, v, -1 - r};
    const double angle = (i - 1) * std::numbers::pi / 12;
    return Vec3{r * std::sin(angle), v, r * (std::cos(angle) - 1)};
  });
  const ModelCurvature curvature(model);
  for (const double v : {0.1, 0.5, 0.9}) {
    EXPECT_NEAR(curvature.of_face(
                    0, {r * std::sin(std::numbers::pi / 4), v, r * (std::cos(std::numbers::pi / 4) - 1)}),
                1 / r, 0.15 / r);
    EXPECT_LT(curvature.of_face(0, {-0.9, v, 0}), 0.1 / r);
    EXPECT_LT(curvature.of_face(0, {r, v, -1}), 0.1 / r);
  }
}

TEST(ModelCurvature, NoiseIsSmoothed) {
  SurfaceModel model = round_sphere(20);
  std::mt19937 random(7);
  for (Vec3& p : model.fine.points) {  // 2 % of the edges
    const double edge = std::numbers::pi / 2 / 20;
    p = (1 + 0.02 * edge * (2 * (random() / double(random.max())) - 1)) * p;
  }
  const auto r = ratios(model, [](const Vec3&) { return 1.0; });
  EXPECT_NEAR(r[r.size() / 2], 1, 0.1);
  EXPECT_LT(r[r.size() * 99 / 100], 1.5);
}

TEST(ModelCurvature, OfACircleThatBoundsAPlaneIsThatOfTheCircle) {
  // A plane ring of radii 0.2 and 1: two closed curves.
  const SurfaceModel model = grid_surface({40, 5, true}, [](double u, double v) {
    const double phi = 2 * std::numbers::pi * u, r = 0.2 + 0.8 * v;
    return Vec3{-r * std::cos(phi), r * std::sin(phi), 0};
  });
  const ModelCurvature curvature(model);
  EXPECT_EQ(curvature.of_face(0, {0.2, 0, 0}), 0);
  std::vector<double> found;
  for (std::size_t l = 0; l < model.fine.lines.size(); ++l) {
    const Vec3& p = model.fine.points[model.fine.lines[l][0]];
    EXPECT_NEAR(curvature.of_curve(model.fine.line_curve[l], p) * norm(p), 1, 1e-9);
  }
  EXPECT_EQ(curvature.of_curve(2, {0, 0, 0}), 0) << "a curve that was added later";
}

}  // namespace
}  // namespace delquad
