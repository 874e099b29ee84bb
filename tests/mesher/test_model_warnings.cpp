#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "delquad/mesher.h"

namespace delquad {
namespace {

std::string warnings_of(const MeshProblem& problem) {
  std::string all;
  for (const Warning& warning : mesh(problem, "DB").warnings) all += warning.text + "\n";
  return all;
}

MeshProblem problem_of(PlanarModel model, double size) {
  MeshProblem problem;
  problem.model = std::move(model);
  problem.size.field = make_constant_size(size);
  return problem;
}

/// Two squares side by side, the second one away by a gap.
PlanarModel squares(double gap) {
  PlanarModel model;
  const auto add = [&](double x, const std::vector<std::string>& names) {
    const std::vector<Vec2> corners = {{x, 0}, {x + 1, 0}, {x + 1, 1}, {x, 1}};
    ModelLoop loop{{}, "", ""};
    for (std::size_t i = 0; i < 4; ++i) {
      loop.curves.push_back(static_cast<int>(model.curves.size()));
      model.curves.push_back({make_segment(corners[i], corners[(i + 1) % 4]), names[i], ""});
    }
    model.loops.push_back(loop);
  };
  add(0, {"s", "east", "n", "w"});
  add(1 + gap, {"s", "e", "n", "west"});
  return model;
}

bool tells(const std::string& all, const std::string& part) { return all.find(part) != std::string::npos; }

TEST(ModelWarnings, GapsBetweenRegions) {
  const std::string all = warnings_of(problem_of(squares(2e-4), 0.1));
  EXPECT_TRUE(tells(all, "leave a gap of 0.0002")) << all;
  EXPECT_TRUE(tells(all, "'east'") && tells(all, "'west'")) << all;
  EXPECT_EQ(std::ranges::count(all, '\n'), 1) << all;
  for (const double gap : {0.0, 2e-3, 0.3}) {
    const std::string none = warnings_of(problem_of(squares(gap), 0.1));
    EXPECT_FALSE(tells(none, "gap")) << gap << ": " << none;
  }
}

TEST(ModelWarnings, ThinRegionsAndSharpCornersAreNoGaps) {
  // A strip of material between two holes, and a corner of three degrees outside.
  const std::string strip = warnings_of(problem_of(
      polygons({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0.2, 0.2}, {0.4998, 0.2}, {0.4998, 0.8}, {0.2, 0.8}}}),
      0.1));
  EXPECT_FALSE(tells(strip, "gap")) << strip;
  const std::string notch = warnings_of(
      problem_of(polygons({{{0, 0}, {1, 0}, {1, 1}, {0.53, 1}, {0.5, 0.43}, {0.47, 1}, {0, 1}}}), 0.1));
  EXPECT_FALSE(tells(notch, "gap")) << notch;
}

TEST(ModelWarnings, SizesByNameThatHaveNoEffect) {
  MeshProblem problem = problem_of(squares(0), 0.1);
  problem.size.named = {{.name = "east", .size = 0.2, .where = "--size-on east=0.2"}};
  const std::string all = warnings_of(problem);
  EXPECT_TRUE(tells(all, "--size-on east=0.2: the size 0.2 of 'east' has no effect")) << all;
  EXPECT_EQ(std::ranges::count(all, '\n'), 1) << all;
  problem.size.named[0].size = 0.05;
  EXPECT_FALSE(tells(warnings_of(problem), "no effect"));
}

}  // namespace
}  // namespace delquad
