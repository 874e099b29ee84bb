// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"

namespace delquad {
namespace {

/// A cube, prepared for meshing, of which faces can be damaged.
class KeepGoing : public ::testing::Test {
 protected:
  KeepGoing() {
    MeshProblem problem = problem_of(TriangleModel{box(1), "cube.off"}, 0.25);
    problem.where = "cube.off";
    prepared_ = prepare_problem(problem);
  }
  /// Makes the boundary of a patch cross itself.
  void damage(int patch) {
    auto& points = prepared_.patches[patch].boundary.points;
    std::swap(points[1], points[9]);
  }
  MeshResult run() { return meshed(prepared_, "DB"); }

  MeshingSetup prepared_;
};

TEST_F(KeepGoing, NothingIsLeftOutOfASoundModel) {
  prepared_.settings.keep_going = true;
  const MeshResult result = run();
  EXPECT_TRUE(result.failures.empty());
  EXPECT_EQ(result.mesh.quads.size(), 96u);
  ASSERT_TRUE(result.surface);
  EXPECT_TRUE(result.surface->mesh.watertight());
  EXPECT_EQ(result.surface->nonconforming_edges.count, 0);
}

TEST_F(KeepGoing, WithoutItTheFaceIsNamed) {
  damage(2);
  expect_input_error([&] { run(); }, {"cube.off: face 3: ", "cross"});
}

TEST_F(KeepGoing, TheRestIsMeshed) {
  prepared_.settings.keep_going = true;
  damage(2);
  const MeshResult result = run();
  ASSERT_EQ(result.failures.size(), 1u);
  EXPECT_EQ(result.failures[0].face, 2);
  EXPECT_EQ(result.failures[0].reason.rfind("face 3: ", 0), 0u) << result.failures[0].reason;
  EXPECT_EQ(result.mesh.quads.size(), 80u);
  EXPECT_EQ(std::count(result.mesh.quad_region.begin(), result.mesh.quad_region.end(), 2), 0);
  EXPECT_EQ(result.mesh.lines.size(), 12u * 4);  // all of them still bound another face
  EXPECT_EQ(result.surface->mesh.free_edges, 16);
  EXPECT_EQ(result.surface->nonconforming_edges.count, 0) << "free where the model without the face is";
}

TEST_F(KeepGoing, LinesAndPointsOfMissingFacesGo) {
  prepared_.settings.keep_going = true;
  // Two that share a curve, which bounds nothing then.
  damage(0);
  damage(2);
  const MeshResult result = run();
  EXPECT_EQ(result.failures.size(), 2u);
  EXPECT_EQ(result.mesh.lines.size(), 11u * 4);
  EXPECT_TRUE(check_invariants(result.mesh).empty());
}

TEST_F(KeepGoing, SomeFaceMustRemain) {
  prepared_.settings.keep_going = true;
  for (int p = 0; p < 6; ++p) damage(p);
  expect_input_error([&] { run(); }, {"no face can be meshed: face 1"});
}

}  // namespace
}  // namespace delquad
