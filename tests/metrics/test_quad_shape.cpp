// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/metrics.h"
#include "metrics/shape.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// A square of diagonal 2, bent by an angle along the diagonal from its first corner.
std::array<Vec3, 4> bent_square(double angle) {
  const double c = std::cos(angle / 2), s = std::sin(angle / 2);
  return {Vec3{-1, 0, 0}, {0, -c, -s}, {1, 0, 0}, {0, c, -s}};
}

Mesh mesh_of(const std::array<Vec3, 4>& quad) {
  Mesh mesh;
  mesh.points.assign(quad.begin(), quad.end());
  mesh.quads = {{0, 1, 2, 3}};
  return mesh;
}

double value(const Mesh& mesh, const char* key) { return evaluate_metrics(mesh, nullptr).values.at(key); }

TEST(QuadWarp, IsTheAngleOfTheBend) {
  for (const double degrees : {0.0, 10.0, 89.0, 90.0, 120.0, 179.0}) {
    std::array<Vec3, 4> quad = bent_square(degrees * kDegree);
    EXPECT_NEAR(quad_warp(quad) / kDegree, degrees, 1e-9);
    // Along the other diagonal it bends by less.
    EXPECT_LE(2 * std::atan(std::sin(degrees / 2 * kDegree)) / kDegree, degrees + 1e-9);
    std::rotate(quad.begin(), quad.begin() + 1, quad.end());
    EXPECT_NEAR(quad_warp(quad) / kDegree, degrees, 1e-9) << "from any corner";
  }
}

TEST(QuadWarp, OverARightAngleIsAFold) {
  for (const auto& [degrees, folded] : {std::pair(89.9, 0), {90.0, 0}, {90.1, 1}, {150.0, 1}}) {
    const Mesh mesh = mesh_of(bent_square(degrees * kDegree));
    EXPECT_EQ(value(mesh, "n_folded"), folded) << degrees;
    EXPECT_EQ(value(mesh, "n_inverted"), 0) << "all angles are below 180 degrees";
    EXPECT_NEAR(value(mesh, "warp_max"), degrees, 1e-9);
    EXPECT_NEAR(value(mesh, "warp_mean"), degrees, 1e-9);
  }
}

TEST(QuadWarp, AReflexCornerIsAFoldAndAStraightOneIsNot) {
  const Mesh dart = mesh_of({Vec3{0, 0, 0}, {2, 2, 0}, {4, 0, 0}, {2, 3, 0}});
  EXPECT_EQ(value(dart, "n_inverted"), 1);
  EXPECT_EQ(value(dart, "n_folded"), 1);
  const Mesh straight = mesh_of({Vec3{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}});
  EXPECT_EQ(value(straight, "n_inverted"), 1);
  EXPECT_EQ(value(straight, "n_folded"), 0);
}

TEST(QuadAspect, IsLongestOverShortestSide) {
  const auto values = evaluate_metrics(quad_grid(2, 1, 6, 1), nullptr).values;
  EXPECT_DOUBLE_EQ(values.at("aspect_max"), 3);
  EXPECT_DOUBLE_EQ(values.at("aspect_mean"), 3);
  EXPECT_EQ(values.at("warp_max"), 0);
  EXPECT_DOUBLE_EQ(value(mesh_of({Vec3{0, 0, 0}, {4, 0, 0}, {3, 1, 0}, {1, 1, 0}}), "aspect_max"),
                   4 / std::sqrt(2.0));
  EXPECT_EQ(value(mesh_of({Vec3{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 1, 0}}), "aspect_max"),
            std::numeric_limits<double>::infinity());
}

struct UniformSize : SizeField {
  explicit UniformSize(double size) : size_(size) {}
  double at(const Vec3&, int&) const override { return size_; }
  double size_;
};

TEST(EdgeLengths, AreOverTheSize) {
  const UniformSize size(0.5), given(2);
  const auto fitted = evaluate_metrics(quad_grid(4, 1, 4, 3), &size).values;
  EXPECT_NEAR(fitted.at("edge_min"), 2, 1e-12);
  EXPECT_NEAR(fitted.at("edge_max"), 6, 1e-12);
  EXPECT_EQ(fitted.at("tau_given"), fitted.at("tau"));
  const auto both = evaluate_metrics(quad_grid(4, 1, 4, 3), &size, &given).values;
  EXPECT_EQ(both.at("tau"), fitted.at("tau"));
  EXPECT_EQ(both.at("tau_given"), evaluate_metrics(quad_grid(4, 1, 4, 3), &given).values.at("tau"));
  EXPECT_NE(both.at("tau_given"), both.at("tau"));
}

TEST(NumberOfShortEdges, CountsInsideOnly) {
  // Columns of widths 1, 0.05 and 1, and three rows: of the short edges two lie inside.
  Mesh mesh = quad_grid(3, 3, 3, 3);
  for (Vec3& p : mesh.points) p.x = p.x < 0.5 ? 0 : p.x < 1.5 ? 1 : p.x < 2.5 ? 1.05 : 2.05;
  const UniformSize size(1), small(0.4);
  const auto values = evaluate_metrics(mesh, &size).values;
  EXPECT_NEAR(values.at("edge_min"), 0.05, 1e-12);
  EXPECT_EQ(values.at("n_short"), 2);
  EXPECT_EQ(values.at("n_thin"), 3);
  EXPECT_EQ(evaluate_metrics(mesh, &small).values.at("n_short"), 0);
  const auto& v = mesh.quads[4];  // the middle of all
  for (int k = 0; k < 4; ++k) mesh.lines.push_back({v[k], v[(k + 1) % 4]});
  EXPECT_EQ(evaluate_metrics(mesh, &size).values.at("n_short"), 0);
}

template <std::size_t N>
void turn_over(std::vector<std::array<int, N>>& elements) {
  for (auto& v : elements) std::ranges::reverse(v);
}

TEST(ElementSides, AFlatMeshMayLookDown) {
  Mesh down = quad_grid(4, 3);
  turn_over(down.quads);
  EXPECT_EQ(value(down, "n_inverted"), 0);
  EXPECT_NEAR(value(down, "eta_worst"), 1, 1e-12);
  Mesh triangles = triangle_grid(3, 3);
  turn_over(triangles.triangles);
  EXPECT_EQ(value(triangles, "n_inverted"), 0);
  // One that looks up among them is inverted, one that looks down among others too.
  std::ranges::reverse(down.quads[5]);
  EXPECT_EQ(value(down, "n_inverted"), 1);
  Mesh up = quad_grid(4, 3);
  std::ranges::reverse(up.quads[5]);
  EXPECT_EQ(value(up, "n_inverted"), 1);
}

TEST(ElementSides, EachRegionHasItsOwn) {
  Mesh mesh = quad_grid(4, 2);
  mesh.regions.push_back({2, {}});
  for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
    mesh.quad_region[q] = q % 4 < 2 ? 0 : 1;
    if (mesh.quad_region[q] == 1) std::ranges::reverse(mesh.quads[q]);
  }
  EXPECT_EQ(value(mesh, "n_inverted"), 0);
  std::ranges::reverse(mesh.quads[0]);
  EXPECT_EQ(value(mesh, "n_inverted"), 1);
}

TEST(ElementSides, CanBeGiven) {
  Mesh down = quad_grid(2, 2);
  turn_over(down.quads);
  EXPECT_EQ(eta_of(quad_shape(down, 0, ElementSides(down, {0, 0, 1})).angle), 0);
  EXPECT_NEAR(eta_of(quad_shape(down, 0, ElementSides(down, {0, 0, -1})).angle), 1, 1e-12);
}

}  // namespace
}  // namespace delquad
