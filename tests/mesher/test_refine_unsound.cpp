// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/finish_steps.h"
#include "mesher/prepare.h"
#include "mesher/runner.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

/// A sheet with a ridge that rises steeply from its feet and fades away inside: its edges are sharp, but lead
/// nowhere.
MeshProblem ridge(double size) {
  TriangleModel sheet;
  sheet.source = "ridge";
  sheet.mesh = triangle_grid(80, 20, 4, 2);
  for (Vec3& p : sheet.mesh.points)
    p.z = 1.2 * std::max(0.0, 1 - std::abs(p.x - 2) / 0.2) * std::max(0.0, 1 - std::abs(p.y - 1) / 0.6);
  MeshProblem problem = problem_of(sheet, size);
  problem.name = problem.where = "ridge";
  return problem;
}

TEST(RefineUnsound, MakesSizesSmallerWhereQuadsCannotBeSound) {
  MeshProblem problem = ridge(0.5);
  problem.options.set("repair.refine_unsound", false);
  EXPECT_THROW(mesh(problem, "DB"), UnsoundError);
  problem.options.set("repair.refine_unsound", true);
  const MeshResult result = mesh(problem, "DB");
  EXPECT_TRUE(result.soundness.sound()) << result.soundness.text();
  EXPECT_GT(result.log.summaries.number("refine_unsound", "rounds"), 0);
  EXPECT_TRUE(is_reported(result.warnings, "the size is smaller"));
}

TEST(RefineUnsound, StaysAwayFromTheRest) {
  const MeshResult result = mesh(ridge(0.5), "DB");
  double longest = 0;
  for (const auto& quad : result.mesh.quads)
    for (int k = 0; k < 4; ++k) {
      const Vec3 a = result.mesh.points[quad[k]], b = result.mesh.points[quad[(k + 1) % 4]];
      if (std::max(a.x, b.x) < 0.6) longest = std::max(longest, norm(b - a));
    }
  EXPECT_GT(longest, 0.3);
}

TEST(RefineUnsound, FindsTheSizeFarFromTheSurface) {
  // Quads across a bore have their middle near its axis, where the field gives the size of the problem.
  MeshProblem problem = problem_of(ExampleModel{"cross_drilled"}, 30);
  problem.order = 2;
  const MeshResult result = mesh(problem, "DBQO");
  EXPECT_GT(result.log.summaries.number("refine_unsound", "rounds"), 1);
  EXPECT_TRUE(result.soundness.sound()) << result.soundness.text();
}

TEST(RefineUnsound, LeavesSoundMeshesAlone) {
  const MeshResult result = mesh(ridge(0.05), "DB");
  EXPECT_FALSE(result.log.summaries.has("refine_unsound"));
}

TEST(RefineUnsound, KeepGoingLeavesOutWhatIsNotSound) {
  MeshProblem problem = ridge(0.5);
  auto& sheets = std::get<TriangleModel>(problem.model).mesh;
  append(sheets, triangle_grid(4, 4, 2, 2), {0, 5, 0});
  problem.options.set("repair.refine_unsound", false);
  EXPECT_THROW(mesh(problem, "DB"), UnsoundError);
  problem.keep_going = true;
  const MeshResult result = mesh(problem, "DB");
  ASSERT_FALSE(result.failures.empty());
  EXPECT_TRUE(holds(result.failures[0].reason, "is not sound"));
  EXPECT_TRUE(result.soundness.sound());
  EXPECT_EQ(result.mesh.quads.size(), 16u) << "of the flat sheet alone";
}

/// A slab of height 1 whose outline has a corner of that angle (radians), 5 long.
MeshProblem needle(double angle) {
  TriangleModel slab;
  slab.source = "needle";
  constexpr int n = 8;
  const auto side = [&](double x) { return x <= 5 ? x * angle : 5 * angle + 0.6 * (x - 5); };
  Mesh& mesh = slab.mesh;
  for (int i = 0; i <= n; ++i) {
    const double x = 10.0 * i / n;
    for (const Vec3& p : {Vec3{x, 0, 0}, Vec3{x, side(x), 0}, Vec3{x, 0, 1}, Vec3{x, side(x), 1}})
      mesh.points.push_back(p);
  }
  const auto add = [&](int a, int b, int c, int d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (int i = 0; i < 4 * n; i += 4) {
    add(i, i + 1, i + 5, i + 4);      // below
    add(i + 2, i + 6, i + 7, i + 3);  // above
    add(i, i + 4, i + 6, i + 2);
    add(i + 1, i + 3, i + 7, i + 5);
  }
  add(4 * n, 4 * n + 1, 4 * n + 3, 4 * n + 2);
  // Both sides meet at the tip.
  for (auto& triangle : mesh.triangles)
    for (int& v : triangle) v = v == 1 ? 0 : v == 3 ? 2 : v;
  std::erase_if(mesh.triangles, [](const auto& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  mesh.regions = {{1, {}}};
  mesh.triangle_region.assign(mesh.triangles.size(), 0);
  MeshProblem problem = problem_of(slab, 0.6);
  problem.name = problem.where = "needle";
  return problem;
}

TEST(RefineUnsound, LeavesOutWhatIsNarrowAtLastAndSaysSo) {
  MeshProblem problem = needle(1e-5 * std::numbers::pi / 180);
  const MeshResult result = mesh(problem, "DBCO");
  EXPECT_TRUE(is_reported(result.warnings, "parts narrower than 0.06, a tenth of the size, are left out"));
  problem.options.set("repair.refine_unsound", false);
  try {
    mesh(problem, "DBCO");
    ADD_FAILURE() << "the test is too easy";
  } catch (const UnsoundError& error) {
    EXPECT_TRUE(holds(error.what(), "in places narrower than the size"));
  }
}

/// A ball whose points are thrown in and out: at this size quads fold.
MeshProblem rubble(int seed) {
  TriangleModel ball;
  ball.source = "rubble";
  ball.mesh = round_sphere(5).fine;
  std::mt19937_64 random(static_cast<std::uint64_t>(seed));
  for (Vec3& p : ball.mesh.points) p = (1 + 0.5 * (2 * shapes::uniform(random) - 1)) * p;
  MeshProblem problem = problem_of(ball, 0.7);
  problem.name = problem.where = "rubble";
  problem.surface.feature_angle = 180;
  problem.allow_unsound = true;
  problem.options.set("repair.ignore_small", false);
  return problem;
}

TEST(RefineUnsound, KeepsTheBestMeshAndSaysWhyItEnds) {
  MeshProblem problem = rubble(1);
  problem.options.set("repair.refine_unsound", false);
  const MeshResult before = mesh(problem, "DB");
  ASSERT_FALSE(before.soundness.sound());
  problem.options.set("repair.refine_unsound", true);
  const MeshResult after = mesh(problem, "DB");
  EXPECT_LE(after.soundness.places.size(), before.soundness.places.size());
  EXPECT_TRUE(after.soundness.sound() || is_reported(after.warnings, "smaller sizes around places"));
  EXPECT_EQ(after.mesh.quads.size() == before.mesh.quads.size(), !after.log.summaries.has("refine_unsound"));
}

TEST(RefineUnsound, TriesFeatureAnglesLast) {
  const MeshProblem problem = ridge(0.2);
  MeshingSetup prepared = prepare_problem(problem);
  const Pipeline word = parse_pipeline("DB");
  MeshResult result = run_pipeline(prepared, word);
  result.soundness = {};
  result.soundness.reasons = {"a test"};
  std::vector<double> tried;
  const auto anew = [&](const RetryHints& hints) {
    tried.push_back(hints.feature_angle);
    if (tried.back() != 25) throw InputError("no mesh");
    MeshProblem other = problem;
    other.surface.feature_angle = tried.back();
    return prepare_problem(other, hints);
  };
  refine_unsound(anew, word, prepared, result);
  EXPECT_EQ(tried, (std::vector<double>{0, 0, 60, 25}));
  EXPECT_TRUE(result.soundness.sound());
  EXPECT_TRUE(is_reported(result.warnings, "with a feature angle of 25 degrees"));
}

TEST(RefineUnsound, TakesAsMuchWorkAsItsQuadsAllow) {
  const MeshProblem problem = ridge(0.5);
  const Pipeline word = parse_pipeline("DB");
  const auto tries_after = [&](long long lifting_cost) {
    MeshingSetup prepared = prepare_problem(problem);
    MeshResult result = run_pipeline(prepared, word);
    result.lifting_cost = lifting_cost;
    std::string tries;
    const auto anew = [&](const RetryHints& hints) -> MeshingSetup {
      if (!hints.spots.empty()) tries += "finer ";
      if (hints.ignore_below > 0) tries += "simpler ";
      throw InputError("no mesh");
    };
    refine_unsound(anew, word, prepared, result);
    return tries;
  };
  EXPECT_EQ(tries_after(3'000'000), "finer simpler ");
  EXPECT_EQ(tries_after(5'400'000), "finer ");
  EXPECT_EQ(tries_after(15'000'000), "");
}

TEST(RefineUnsound, CountsAllWork) {
  const MeshingSetup prepared = prepare_problem(ridge(0.2));
  MeshResult result = run_pipeline(prepared, parse_pipeline("DB"));
  const long long made = work_on(prepared, result);
  EXPECT_GT(made, static_cast<long long>(result.mesh.quads.size()));
  result.log.summaries.add("cleanup", {{"looks", 3'000'000LL}});
  EXPECT_EQ(work_on(prepared, result), made + 10'000);
  result.lifting_cost += 300'000;
  EXPECT_EQ(work_on(prepared, result), made + 11'000);
}

}  // namespace
}  // namespace delquad
