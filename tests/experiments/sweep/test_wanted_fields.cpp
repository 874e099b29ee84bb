// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/wanted_fields.h"
#include "tests/support/files.h"
#include "tests/support/triangulated_shapes.h"

namespace delquad {
namespace {

PlanarModel unit_square() {
  PlanarModel model;
  model.curves.emplace_back().shape = make_polyline({{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}});
  model.loops.emplace_back().curves = {0};
  return model;
}

Vec3 vector_at(const MeshField& field, std::size_t i) {
  return {field.values[3 * i], field.values[3 * i + 1], field.values[3 * i + 2]};
}

/// The content of a file of the mesh of a problem.
MeshWithFields fields_of(const MeshProblem& problem) {
  const Folder folder;
  const MeshResult result = mesh(prepare(problem), "DB");
  write_wanted(folder / "fields.vtu", result.mesh, result.prepared);
  MeshWithFields read = read_fields(folder / "fields.vtu");
  std::erase_if(read.fields, [](const MeshField& field) { return !field.is_of_points; });
  EXPECT_EQ(read.fields.size(), 3u);
  std::ranges::rotate(read.fields, read.fields.end() - 1);  // they come by name
  EXPECT_EQ(read.fields[0].values.size(), result.mesh.points.size());
  return read;
}

TEST(WantedFields, ArePointDataOfPlanes) {
  MeshProblem problem;
  problem.model = unit_square();
  problem.size.text = "0.1 + 0.1 * x";
  problem.cross.text = "pi / 6";
  const auto [mesh, fields] = fields_of(problem);
  EXPECT_EQ(fields[0].name + " " + fields[1].name + " " + fields[2].name, "size cross_1 cross_2");
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const double size = 0.1 + 0.1 * mesh.points[i].x;
    EXPECT_NEAR(fields[0].values[i], size, 1e-12);
    // Which of the four directions comes first does not matter.
    const double angle = std::atan2(vector_at(fields[1], i).y, vector_at(fields[1], i).x) * 6 / M_PI;
    EXPECT_NEAR(std::remainder(angle - 1, 3), 0, 1e-9);
    for (const int k : {1, 2}) EXPECT_NEAR(norm(vector_at(fields[k], i)), size, 1e-12);
    EXPECT_NEAR(dot(vector_at(fields[1], i), vector_at(fields[2], i)), 0, 1e-12);
  }
}

/// On a box crosses lie in its faces, along its edges.
TEST(WantedFields, ArePointDataOfSurfaces) {
  MeshProblem problem;
  problem.model = TriangleModel{testing_support::box(4)};
  problem.size.text = "0.2";
  const auto [mesh, fields] = fields_of(problem);
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    EXPECT_NEAR(fields[0].values[i], 0.2, 1e-12);
    for (const int k : {1, 2}) {
      const Vec3 edge = vector_at(fields[k], i);
      EXPECT_NEAR(norm(edge), 0.2, 1e-9);
      EXPECT_NEAR(std::max({std::abs(edge.x), std::abs(edge.y), std::abs(edge.z)}), 0.2, 0.01);
    }
  }
}

/// A metric asks for other lengths along its two axes.
TEST(WantedFields, HaveTheAxesOfAMetric) {
  MeshProblem problem;
  problem.model = unit_square();
  problem.metric.sizes = {"0.05", "0.2"};
  const auto [mesh, fields] = fields_of(problem);
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    EXPECT_NEAR(fields[0].values[i], 0.1, 1e-3);
    EXPECT_NEAR(std::abs(vector_at(fields[1], i).x), 0.05, 1e-3);
    EXPECT_NEAR(std::abs(vector_at(fields[2], i).y), 0.2, 4e-3);
  }
}

}  // namespace
}  // namespace delquad
