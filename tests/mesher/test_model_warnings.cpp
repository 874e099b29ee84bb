// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"

namespace delquad {
namespace {

std::string warnings_of(const MeshProblem& problem) {
  std::string all;
  for (const Warning& warning : mesh(problem, "DB").warnings) all += warning.text + "\n";
  return all;
}

/// Two squares side by side, the second one away by a gap.
PlanarModel squares(double gap) {
  return ModelMaker()
      .rectangle({0, 0}, {1, 1}, {"s", "east", "n", "w"})
      .rectangle({1 + gap, 0}, {2 + gap, 1}, {"s", "e", "n", "west"});
}

TEST(ModelWarnings, GapsBetweenRegions) {
  const std::string all = warnings_of(problem_of(squares(2e-4), 0.1));
  EXPECT_TRUE(holds(all, "leave a gap of 0.0002", "'east'", "'west'"));
  EXPECT_EQ(std::ranges::count(all, '\n'), 1) << all;
  for (const double gap : {0.0, 2e-3, 0.3}) {
    const std::string none = warnings_of(problem_of(squares(gap), 0.1));
    EXPECT_FALSE(holds(none, "gap")) << gap << ": " << none;
  }
}

TEST(ModelWarnings, ThinRegionsAndSharpCornersAreNoGaps) {
  // A strip of material between two holes, and a corner of three degrees outside.
  const std::string strip = warnings_of(problem_of(
      polygons({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0.2, 0.2}, {0.4998, 0.2}, {0.4998, 0.8}, {0.2, 0.8}}}),
      0.1));
  EXPECT_FALSE(holds(strip, "gap")) << strip;
  const std::string notch = warnings_of(
      problem_of(polygons({{{0, 0}, {1, 0}, {1, 1}, {0.53, 1}, {0.5, 0.43}, {0.47, 1}, {0, 1}}}), 0.1));
  EXPECT_FALSE(holds(notch, "gap")) << notch;
}

TEST(ModelWarnings, SizesByNameThatHaveNoEffect) {
  MeshProblem problem = problem_of(squares(0), 0.1);
  problem.size.named = {{.name = "east", .size = 0.2, .where = "--size-on east=0.2"}};
  const std::string all = warnings_of(problem);
  EXPECT_TRUE(holds(all, "--size-on east=0.2: the size 0.2 of 'east' has no effect"));
  EXPECT_EQ(std::ranges::count(all, '\n'), 1) << all;
  problem.size.named[0].size = 0.05;
  EXPECT_FALSE(holds(warnings_of(problem), "no effect"));
}

}  // namespace
}  // namespace delquad
