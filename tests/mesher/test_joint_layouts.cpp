// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"

namespace delquad {
namespace {

constexpr double kRidge = 8;

/// Two squares with an edge in common, one lying, one standing.
MeshProblem folded_sheet() {
  Mesh sheet;
  sheet.points = {{0, 0, 0},      {kRidge, 0, 0}, {kRidge, kRidge, 0},
                  {0, kRidge, 0}, {kRidge, 0, 8}, {kRidge, kRidge, 8}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
  sheet.triangle_region = {0, 0, 1, 1};
  sheet.regions = {{1, {"floor"}}, {2, {"wall"}}};
  MeshProblem problem = problem_of(TriangleModel{sheet});
  // More edges on the ridge than beside.
  problem.size.field = make_function_size(
      [](const Vec3& p) { return std::max(p.z, kRidge - p.x) > 0.5 ? 1.0 : 0.8; }, "finer at the ridge");
  problem.size.gradation = 0;
  return problem;
}

TEST(LayoutsTogether, AFoldedSheetBecomesTwoGrids) {
  const auto run = [](const char* word, int threads) {
    MeshProblem problem = folded_sheet();
    problem.options.set("curves.agreement", 0.0);
    return mesh(problem, word, {.threads = threads});
  };
  const MeshResult without = run("DBCO", 1), result = run("DBCRO", 1), parallel = run("DBCRO", 3);
  ASSERT_GT(without.metrics.values.at("n_beyond"), 0);
  EXPECT_EQ(result.metrics.values.at("n_beyond"), 0);
  EXPECT_EQ(result.log.summaries.get<long long>("layouts_together", "accepted"), 1);
  EXPECT_GT(result.log.summaries.get<long long>("layouts_together", "curves"), 0);
  EXPECT_TRUE(result.soundness.sound()) << result.soundness.text();
  EXPECT_EQ(result.mesh.regions.at(1).names, std::vector<std::string>{"wall"});
  EXPECT_EQ(parallel.mesh.points, result.mesh.points);
  EXPECT_EQ(parallel.mesh.quads, result.mesh.quads);
}

TEST(LayoutsTogether, CurvesWithGivenEdgesKeepThem) {
  MeshProblem problem = folded_sheet();
  problem.divisions = {{"curve_1", 12}};
  problem.options.set("regularity.weight", 100.0);
  const MeshResult with = mesh(problem, "DBCRO"), without = mesh(problem, "DBCO");
  const auto lines = [](const MeshResult& made) {
    return std::ranges::count_if(made.mesh.line_curve, [&](int c) { return made.mesh.curves[c].tag == 1; });
  };
  EXPECT_EQ(lines(with), 12);
  EXPECT_EQ(lines(without), 12);
}

TEST(RegularityWeight, CountsForNumbersOfEdgesAndForStages) {
  const auto run = [](std::vector<std::string> keys, bool weighed) {
    MeshProblem problem = folded_sheet();
    for (const std::string& key : keys) problem.options.set(key, 0.0);
    if (weighed) problem.options.set("regularity.weight", 0.0);
    return mesh(problem, "DBCQRO").mesh.points;
  };
  const auto weighed = run({}, true), none = run({"curves.agreement", "regularity.tolerance"}, false);
  EXPECT_TRUE(weighed == none);
  EXPECT_FALSE(weighed == run({"regularity.tolerance"}, false));
  EXPECT_TRUE(run({"curves.agreement"}, true) == run({"curves.agreement", "regularity.tolerance"}, false));
  EXPECT_FALSE(run({"curves.agreement"}, true) == run({"curves.agreement"}, false));
}

}  // namespace
}  // namespace delquad
