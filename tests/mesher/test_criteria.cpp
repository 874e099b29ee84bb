// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/features/layers/layered_model.h"

namespace delquad {
namespace {

Criteria preset(const std::string& name) { return read_criteria(name); }

MeshProblem judged_problem(const std::vector<std::vector<Vec2>>& loops, double size,
                           const Criteria& criteria) {
  MeshProblem problem = problem_of(polygons(loops), size);
  problem.criteria = criteria;
  return problem;
}

const CriterionResult& result_of(const CriteriaReport& report, const std::string& key) {
  return *std::ranges::find_if(report.results, [&](const auto& r) { return r.limit.key == key; });
}

TEST(Criteria, PresetsSayWhereTheyAreFrom) {
  for (const char* name : {"batch", "crash", "static"}) {
    EXPECT_FALSE(preset(name).source.empty());
    check_criteria(preset(name));
  }
  expect_input_error([] { preset("crsh"); }, {"'crsh'", "batch, crash, static", "did you mean 'crash'"});
}

TEST(Criteria, RefuseWhatCannotBe) {
  Criteria c;
  expect_input_error([&] { c.set("min_lenght", "1"); }, {"'min_lenght'", "did you mean 'min_length'"});
  expect_input_error([&] { c.set("min_length", "1.2 size", "", "f.toml:3"); }, {"f.toml:3", "1.2 size"});
  expect_input_error([&] { c.set("max_length", "0.9 size"); }, {"below the wanted size"});
  for (const char* value : {"-1", "0", "much", "nan", "", "1 sizes"})
    expect_input_error([&] { c.set("min_length", value); }, {"expected a number above 0"});
  expect_input_error([&] { c.set("min_angle", "91"); }, {"from 0 to 90 degrees"});
  expect_input_error([&] { c.set("max_aspect", "0.5"); }, {"from 1"});
  EXPECT_TRUE(c.empty());
}

TEST(Criteria, RefuseWhatContradictsItself) {
  Criteria c;
  c.set("max_length", "2").set("min_length", "1", "", "f.toml:2");
  check_criteria(c);
  c.set("min_length", "3", "rim", "f.toml:7");
  expect_input_error([&] { check_criteria(c); },
                     {"f.toml:7", "'min_length' is 3", "'max_length' 2", "no element is within both"});
}

/// Plates with two holes, between which and the sides there is room for one or two quads.
long long failing_beside_holes(const char* word) {
  long long failing = 0;
  for (const double radius : {0.41, 0.42, 0.43, 0.44}) {
    MeshProblem problem = ModelMaker()
                              .loop({make_polyline({{0, 0}, {2, 0}, {2, 1}, {0, 1}, {0, 0}})})
                              .circle({0.5, 0.5}, radius)
                              .circle({1.5, 0.5}, radius)
                              .problem(0.07);
    problem.criteria = preset("batch");
    failing += mesh(problem, word).criteria->failing;
  }
  return failing;
}

TEST(Criteria, MoreIsBeyondThemWithFewerStages) {
  const long long raw = failing_beside_holes("DB");
  for (const char* word : {"DBCO", "DBCQO"}) EXPECT_LT(10 * failing_beside_holes(word), raw) << word;
}

TEST(Criteria, RefuseTimesWithoutAMaterial) {
  Criteria c;
  c.set("min_time_step", "1e-7", "", "f.toml:4");
  expect_input_error([&] { check_criteria(c); }, {"f.toml:4", "needs a material"});
  c.material = Material{210e3, 0.3, 0};
  expect_input_error([&] { check_criteria(c); }, {"density 0"});
}

TEST(Criteria, AreRefusedBeforeMeshingWhereTheSizeIsWithinNone) {
  Criteria c;
  c.set("min_length", "1", "", "f.toml:1");
  const auto prepare_square = [&] { prepare(judged_problem({rectangle({0, 0}, {4, 4})}, 0.5, c)); };
  expect_input_error(prepare_square, {"f.toml:1", "'min_length' is 1", "0.5 at most"});
  c = Criteria().set("max_aspect", "3", "rim", "f.toml:2");
  expect_input_error(prepare_square, {"f.toml:2", "no curve and no region is called 'rim'"});
}

TEST(Criteria, ArePassedBySquares) {
  Criteria strict = preset("batch");
  strict.strict = true;
  const MeshResult result = mesh(judged_problem({rectangle({0, 0}, {4, 4})}, 0.5, strict), "DB");
  ASSERT_TRUE(result.criteria);
  EXPECT_EQ(result.criteria->failing, 0);
  EXPECT_TRUE(result.criteria->why.empty());
  EXPECT_EQ(result.metrics.values.at("failing"), 0);
  EXPECT_EQ(result.metrics.values.at("failing_min_length"), 0);
  EXPECT_NEAR(result.metrics.values.at("time_step"), 1, 1e-3);
  EXPECT_EQ(result.metrics.values.count("failing_max_skew"), 0u);
}

TEST(Criteria, AreAimedAtByAllStages) {
  long long failing = 0, elements = 0;
  for (const double gap : {0.8, 1.0, 1.2, 1.4, 1.6}) {
    MeshProblem problem = ModelMaker()
                              .rectangle({0, 0}, {16, 9})
                              .circle({6 - gap / 2, 4.5}, 2)
                              .circle({10 + gap / 2, 4.5}, 2)
                              .problem(1);
    problem.cross.kind = CrossKind::kSizeAware;
    problem.criteria = preset("crash");
    const CriteriaReport report = *mesh(problem, "DBQO").criteria;
    failing += report.failing, elements += report.elements;
  }
  EXPECT_LT(failing, 0.05 * static_cast<double>(elements));
}

TEST(Criteria, CountLengthsInTheSizeByCurvature) {
  MeshProblem plate = ModelMaker().rectangle({0, 0}, {20, 20}).circle({10, 10}, 1).problem(2);
  MeshProblem bracket = problem_of(ExampleModel{"bracket"}, 6);
  for (MeshProblem* problem : {&plate, &bracket}) {
    problem->size.curvature = 24;
    problem->cross.kind = CrossKind::kSizeAware;
    problem->criteria = preset("batch");
    const CriteriaReport report = *mesh(*problem, "DBQO").criteria;
    EXPECT_LT(static_cast<double>(report.failing), 0.01 * static_cast<double>(report.elements));
  }
}

TEST(Criteria, UsualOnesLeaveThePlaneAsItIs) {
  const auto problem = [](const Criteria& c) {
    return judged_problem({{{0, 0}, {6, -0.7}, {5, 1}}}, 0.2, c);
  };
  const MeshResult with = mesh(problem(preset("batch")), "DB"), without = mesh(problem({}), "DB");
  EXPECT_EQ(with.mesh.points, without.mesh.points);
  EXPECT_EQ(with.mesh.quads, without.mesh.quads);
  EXPECT_FALSE(without.criteria);
  EXPECT_EQ(without.metrics.values.count("failing"), 0u);
  EXPECT_GT(with.criteria->failing, 0);
  EXPECT_TRUE(with.soundness.accepted());
}

TEST(Criteria, AreAnErrorWhenStrict) {
  Criteria c;
  c.set("min_angle", "20").strict = true;
  try {
    mesh(judged_problem({{{0, 0}, {6, -0.5}, {6, 0.5}}}, 0.2, c), "DB");
    FAIL() << "a corner of ten degrees passed";
  } catch (const UnsoundError& error) {
    EXPECT_TRUE(holds(error.what(), "an angle below 20 degrees, the least 9.5"));
    ASSERT_TRUE(error.result->criteria);
    const CriterionResult& angle = result_of(*error.result->criteria, "min_angle");
    EXPECT_EQ(angle.cause, "corner");
    EXPECT_LT(angle.worst, 10);
    EXPECT_LT(norm(angle.at.at), 1);
  }
}

TEST(Criteria, NameWhatStandsInTheWay) {
  const auto cause_of = [](const std::vector<std::vector<Vec2>>& loops, double size, const char* key) {
    const MeshResult result = mesh(judged_problem(loops, size, read_criteria("batch")), "DB");
    return result_of(*result.criteria, key).cause;
  };
  // A corner of 25 degrees, a gap of 0.2, a notch with sides of .2.
  EXPECT_EQ(cause_of({{{0, 0}, {6, 0}, {6, 2.8}}}, 0.4, "min_angle"), "corner");
  EXPECT_EQ(
      cause_of({rectangle({0, 0}, {20, 20}), rectangle({5, 8}, {8, 11}), rectangle({8.2, 8.5}, {11.2, 11.5})},
               1, "min_angle"),
      "narrow gap");
  EXPECT_EQ(cause_of({{{0, 0}, {10, 0}, {10, 5}, {9.8, 5}, {9.8, 10}, {0, 10}}}, 1, "min_length"),
            "short curve");
}

TEST(Criteria, OfANameCountInPlaceOfOthers) {
  ModelMaker model;
  model.rectangle({0, 0}, {4, 4}, {"wall", "out", "far", "in"});
  MeshProblem problem = model.problem(0.5, {});
  problem.criteria.set("max_length", "0.6").set("max_length", "0.5", "wall");
  const MeshResult strict = mesh(problem, "DB");
  ASSERT_EQ(strict.criteria->results.size(), 2u);
  problem.criteria.set("max_length", "0.55").set("max_length", "9", "wall");
  const MeshResult loose = mesh(problem, "DB");
  EXPECT_EQ(loose.criteria->results[1].failing.size(), 0u);
  // All others are judged by the one without a name.
  const auto at_wall = [&](int q) {
    int on = 0;
    for (const int v : loose.mesh.quads[q]) on += loose.mesh.points[v].y == 0;
    return on == 2;
  };
  for (const int q : loose.criteria->results[0].failing) EXPECT_FALSE(at_wall(q));
}

TEST(Criteria, LeaveLayersOut) {
  ModelMaker model;
  model.rectangle({0, 0}, {4, 4}, {"wall", "out", "far", "in"});
  MeshProblem problem = model.problem(0.2, {layer_on({"wall"}, 1e-4, 20)});
  problem.criteria.set("min_length", "0.1 size").set("max_aspect", "20");
  EXPECT_EQ(mesh(problem, "DB").criteria->failing, 0);
}

TEST(Criteria, JudgeMeshesOfOthersAlike) {
  const MeshProblem problem = judged_problem({{{0, 0}, {6, 0}, {6, 2.8}}}, 0.4, preset("crash"));
  const MeshResult made = mesh(problem, "DB");
  const auto size = make_constant_size(0.4);
  const CriteriaReport others = judge(made.mesh, preset("crash"), size.get());
  EXPECT_EQ(others.failing, made.criteria->failing);
  EXPECT_EQ(others.critical_step, made.criteria->critical_step);
  for (std::size_t k = 0; k < others.results.size(); ++k)
    EXPECT_EQ(others.results[k].failing, made.criteria->results[k].failing);
  const CriteriaReport by_mean = judge(made.mesh, preset("crash"));
  EXPECT_NE(by_mean.step_of_squares, others.step_of_squares);
  EXPECT_NEAR(by_mean.step_of_squares, 0.4, 0.05);
}

TEST(Criteria, TimesAreByTheMaterial) {
  MeshProblem problem = judged_problem({rectangle({0, 0}, {4, 4})}, 0.5, {});
  problem.criteria.material = Material{200, 0, 2};  // a speed of 10
  problem.criteria.set("min_time_step", "0.06", "", "f.toml:1");
  expect_input_error([&] { prepare(problem); }, {"f.toml:1", "over a length of 0.6", "0.5 at most"});
  problem.criteria.set("min_time_step", "0.05").set("min_length", "0.4");
  const CriteriaReport report = *mesh(problem, "DB").criteria;
  EXPECT_NEAR(report.critical_step, 0.05, 1e-4);
  EXPECT_NEAR(report.estimated_step.at("abaqus"), 0.05, 1e-9);
  EXPECT_EQ(report.failing, 0);
  EXPECT_NEAR(result_of(report, "min_time_step").worst, 0.05, 1e-9);
}

}  // namespace
}  // namespace delquad
