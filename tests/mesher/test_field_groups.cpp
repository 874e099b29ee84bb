// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"

namespace delquad {
namespace {

MeshingSetup with_size_aware_crosses(const Mesh& model, double size) {
  MeshProblem problem = problem_of(TriangleModel{model}, size);
  problem.cross.kind = CrossKind::kSizeAware;
  return prepare_problem(problem);
}

void expect_indices(const MeshingSetup& prepared, int sum) {
  ASSERT_TRUE(prepared.crosses.index_sum_and_expected);
  EXPECT_EQ(prepared.crosses.index_sum_and_expected->first, sum);
  EXPECT_EQ(prepared.crosses.index_sum_and_expected->second, sum);
  int of_list = 0;
  for (const PlacedSingularity& s : prepared.crosses.singularities) of_list += s.index;
  EXPECT_EQ(of_list, sum);
}

TEST(FieldGroups, ClosedSurfacesHaveTheSingularitiesOfTheirGenus) {
  const MeshingSetup sphere = with_size_aware_crosses(round_sphere(16).fine, 0.1);
  ASSERT_GT(sphere.patches.size(), 1u);
  expect_indices(sphere, 8);
  for (const PlacedSingularity& s : sphere.crosses.singularities) EXPECT_NEAR(norm(s.at), 1, 0.01);
  expect_indices(with_size_aware_crosses(torus(48, 24, 1, 0.4).fine, 0.1), 0);
  expect_indices(with_size_aware_crosses(double_torus(6).fine, 0.2), -8);
}

/// Two unit squares as two faces, the second bent up by `bend` (radians). Where `bend` is 0, they are divided
/// along the slanted line from (1.2, 0) to (0.8, 1).
Mesh two_faces(double bend) {
  Mesh mesh = triangle_grid(16, 8, 2, 1);
  mesh.lines.clear();
  mesh.line_curve.clear();
  mesh.curves.clear();
  mesh.regions = {{1, {}}, {2, {}}};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    double x = 0;
    for (const int v : mesh.triangles[t]) x += mesh.points[v].x / 3;
    mesh.triangle_region[t] = x > 1 ? 1 : 0;
  }
  for (Vec3& p : mesh.points) {
    const double line = 1.2 - 0.4 * p.y;
    p.x = p.x < 1 ? line * p.x : line + (2 - line) * (p.x - 1);
    const double beyond = std::max(p.x - line, 0.0);
    p = {p.x - beyond * (1 - std::cos(bend)), p.y, beyond * std::sin(bend)};
  }
  return mesh;
}

/// Angle between the field in the middle of the common curve and the direction along the first face's sides.
double turn_at_curve(const MeshingSetup& prepared) {
  const PatchSetup& patch = prepared.patches[0];
  // The patch's plane is the face's: the way along x tells how it lies there.
  int hint = -1;
  double theta = NAN;
  const TriPatch& map = prepared.surface->domain.patches[0].map.flat;
  const auto& nodes = prepared.surface->domain.patches[0].map.fine_node;
  const std::vector<Vec3>& places = prepared.surface->model.fine.points;
  for (const auto& v : map.triangles) {
    const Vec3 p = places[nodes[v[0]]], q = places[nodes[v[1]]], r = places[nodes[v[2]]];
    const Vec3 middle = (1.0 / 3) * (p + q + r);
    if (std::abs(middle.y - 0.5) > 0.1 || std::abs(middle.x - 1) > 0.1) continue;
    const Vec2 u = (1.0 / 3) * (map.points[v[0]] + map.points[v[1]] + map.points[v[2]]);
    const Vec2 side = map.points[v[1]] - map.points[v[0]];
    const double turned = std::atan2(side.y, side.x) - std::atan2(q.y - p.y, q.x - p.x);
    theta = std::abs(std::remainder(patch.cross->at(u, hint).angle() - turned, std::numbers::pi / 2));
  }
  return theta;
}

TEST(FieldGroups, FieldsGoOnAcrossSmoothCurvesOnly) {
  const MeshingSetup flat = with_size_aware_crosses(two_faces(0), 0.04);
  const MeshingSetup bent = with_size_aware_crosses(two_faces(0.8), 0.04);
  ASSERT_EQ(flat.patches.size(), 2u);
  ASSERT_EQ(bent.patches.size(), 2u);
  EXPECT_EQ(flat.crosses.index_sum_and_expected, std::pair(4, 4));
  EXPECT_EQ(bent.crosses.index_sum_and_expected, std::pair(8, 8));
  // The line is slanted by .38.
  EXPECT_GT(turn_at_curve(bent), 0.25);
  EXPECT_LT(turn_at_curve(flat), turn_at_curve(bent) - 0.03);
}

}  // namespace
}  // namespace delquad
