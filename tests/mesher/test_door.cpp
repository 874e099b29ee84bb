// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"

namespace delquad {
namespace {

MeshProblem plate() {
  MeshProblem problem =
      problem_of(polygons({{{0, 0}, {3, 0}, {3, 2}, {0, 2}}, {{1, 0.5}, {2, 0.5}, {1.5, 1.5}}}));
  problem.name = "plate";
  problem.size.text = "0.1 + 0.05*x";
  return problem;
}

void expect_same(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.quads, b.quads);
  EXPECT_EQ(a.triangles, b.triangles);
}

TEST(Door, AllWaysLeadToTheSameMesh) {
  const MeshResult whole = mesh(plate(), "DBCO");
  const Prepared prepared = prepare(plate());
  const MeshResult result = mesh(prepared, "DBCO");
  expect_same(whole.mesh, result.mesh);
  Meshing meshing(prepared);
  for (const Stage* stage : parse_pipeline("DBCO").stages) {
    meshing.run(*stage);
    EXPECT_EQ(meshing.mesh().quads.empty(), stage->letter == 'D') << stage->letter;
  }
  const MeshResult last = meshing.finish();
  expect_same(whole.mesh, last.mesh);
  EXPECT_EQ(whole.metrics.values.at("eta_mean"), prepared.metrics(last.mesh).values.at("eta_mean"));
  EXPECT_NEAR(static_cast<double>(last.mesh.quads.size()), last.prepared->size.expected_quads,
              0.1 * last.prepared->size.expected_quads);
  // Once each, stages of the preparation first.
  EXPECT_EQ(last.log.times.front().first, "read");
  for (const char* step : {"read", "fields", "insertion", "metrics"})
    EXPECT_EQ(std::ranges::count(last.log.times, step, &StepTimes::value_type::first), 1) << step;
}

TEST(Door, WhatNobodySaysIsGood) {
  const Quality& good = quality_named("good");
  MeshProblem as_good = plate();
  as_good.options = good.options;
  MeshProblem said = plate();
  // Directions that are said count more than the quality.
  said.cross.kind = CrossKind::kBoundary;
  expect_same(mesh(said, "good").mesh, mesh(as_good, good.pipeline).mesh);
  as_good.cross.kind = good.cross;
  expect_same(mesh(plate()).mesh, mesh(as_good, good.pipeline).mesh);
  expect_refused(plate(), "god", {"unknown stage"});
}

TEST(Door, TextsMeanWhatTheirFieldsMean) {
  MeshProblem by_field = plate();
  by_field.size = {.field = make_expression_size("0.1 + 0.05*x")};
  expect_same(mesh(plate(), "DB").mesh, mesh(by_field, "DB").mesh);
  MeshProblem turned = plate(), by_angle = plate();
  turned.cross.text = "0.3";
  by_angle.cross = {.kind = CrossKind::kField, .field = make_expression_cross("0.3")};
  expect_same(mesh(turned, "DB").mesh, mesh(by_angle, "DB").mesh);
  turned.cross.text = "size-awere";
  expect_input_error([&] { prepare(turned); }, {"cross", "size-aware"});
  turned.cross.text = "boundary", turned.size.text = "0.1 +";
  expect_input_error([&] { prepare(turned); }, {"size"});
}

TEST(Door, FilesAreReadWhenTheyAreMeshed) {
  const TemporaryFolder folder;
  const auto file = folder / "box.msh";
  MeshProblem by_file, by_mesh;
  by_file.model = ModelFile{file};
  by_file.size.text = by_mesh.size.text = "0.25";
  expect_input_error([&] { prepare(by_file); }, {"box.msh"});
  by_mesh.model = TriangleModel{box(1)};
  write_mesh(file, std::get<TriangleModel>(by_mesh.model).mesh);
  const Prepared prepared = prepare(by_file);
  EXPECT_TRUE(prepared.is_surface());
  EXPECT_EQ(prepared.fine().triangles.size(), std::get<TriangleModel>(by_mesh.model).mesh.triangles.size());
  expect_same(mesh(prepared, "DB").mesh, mesh(by_mesh, "DB").mesh);
  EXPECT_EQ(model_info(by_file).report.faces.size(), 6u);
  // Words may begin from the elements of a given mesh.
  expect_refused(by_file, "B", {"starts from"});
}

TEST(Door, HasAVersion) { EXPECT_EQ(std::ranges::count(std::string(version()), '.'), 2); }

}  // namespace
}  // namespace delquad
