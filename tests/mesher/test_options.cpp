// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/insertion/frontal_mesher.h"
#include "algorithms/treatment/treatment.h"
#include "delquad/matching.h"
#include "smoothing/cvt/smooth_points.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

TEST(OptionValues, AreThoseOfTheStructsUntilTheyAreSet) {
  Options options;
  EXPECT_EQ(options.number("insertion.rejection"), FrontalOptions{}.rejection);
  EXPECT_EQ(options.integer("smoothing.p"), SmoothingOptions{}.p);
  EXPECT_EQ(options.text("recombination.treatment"), "paper");
  EXPECT_EQ(options.text("recombination.solver"), "primal-dual");
  EXPECT_TRUE(options.flag("repair.part_twins"));
  EXPECT_EQ(options.find("insertion.rejection"), nullptr);
  options.set("insertion.rejection", 0.5)
      .set("recombination.solver", "lemon")
      .set("smoothing.outer_iterations", 3);
  EXPECT_EQ(insertion_options(options).rejection, 0.5);
  EXPECT_EQ(recombination_options(options).solver, "lemon");
  EXPECT_EQ(smoothing_options(options).outer_iterations, 3);
  options.reset("insertion.rejection").reset("recombination.solver").reset("smoothing.outer_iterations");
  EXPECT_EQ(options, Options{});
}

TEST(OptionValues, WhatIsSetStaysWhereOthersHaveMore) {
  Options options = Options{}.set("smoothing.p", 8);
  options.set_absent(Options{}.set("smoothing.p", 4).set("regularity.rounds", 3));
  EXPECT_EQ(options, Options{}.set("smoothing.p", 8).set("regularity.rounds", 3));
  EXPECT_TRUE(quality_named("best").options.flag("curves.round_holes"));
}

TEST(OptionValues, WhereFacesAreJoinedRegularityMayCostMore) {
  const auto prepared = [](Compounds compounds, const Options& options) {
    MeshProblem problem;
    problem.surface.compounds = compounds;
    problem.options = options;
    return prepare_surface(problem, cylinder(12, 4, 1, 2), make_constant_size(0.5)).settings.options;
  };
  const auto tolerance = [&](Compounds compounds, const Options& options) {
    return prepared(compounds, options).number("regularity.tolerance");
  };
  EXPECT_EQ(tolerance(Compounds::kNone, {}), 3);
  EXPECT_EQ(tolerance(Compounds::kAll, {}), 12);
  EXPECT_EQ(tolerance(Compounds::kAll, quality_named("good").options), 0);
  EXPECT_EQ(tolerance(Compounds::kAll, Options{}.set("regularity.weight", 2)), 12) << "it counts once, later";
  EXPECT_EQ(prepare_problem(problem_of(TriangleModel{can(12, 4)}, 0.5), {})
                .settings.options.number("regularity.tolerance"),
            12);
  EXPECT_EQ(prepared(Compounds::kAll, {}).integer("regularity.quads"), 1000);
  EXPECT_EQ(prepared(Compounds::kAll, Options{}.set("regularity.quads", 50)).integer("regularity.quads"), 50);
}

TEST(OptionValues, InAFineMeshRegularityMayCostAsManyTimesMore) {
  MeshProblem problem;
  for (const int usual : {0, 10, 100, 1000}) {
    problem.options.set("regularity.usual_quads", usual);
    const auto prepared = prepare_surface(problem, cylinder(12, 4, 1, 2), make_constant_size(0.2));
    ASSERT_GT(prepared.size.expected_quads, 200);
    const double times = usual > 0 ? std::clamp(prepared.size.expected_quads / usual, 1.0, 4.0) : 1;
    EXPECT_NEAR(prepared.settings.options.number("regularity.tolerance"), 3 * times, 1e-9) << usual;
  }
}

TEST(OptionValues, AWholeNumberWillDoForANumber) {
  EXPECT_EQ(Options{}.set("optimisation.size", 1).number("optimisation.size"), 1.0);
  expect_input_error([] { Options{}.set("regularity.rounds", 1.0); },
                     {"'regularity.rounds' is 1", "a whole number"});
}

TEST(OptionValues, MistakesAreNamed) {
  const auto set = [](const char* name, OptionValue value) { Options{}.set(name, std::move(value)); };
  expect_input_error([&] { set("insertion.hmax", 1.3); },
                     {"unknown option 'insertion.hmax'", "did you mean 'insertion.h_max'?"});
  expect_input_error([&] { set("h_max", 1.3); }, {"unknown option 'h_max'"});
  expect_input_error([&] { set("insertion.", 1.3); }, {"unknown option"});
  expect_input_error([&] { set("", 1.3); }, {"unknown option"});
  expect_input_error([&] { set("insertion.h_max", 5.0); },
                     {"'insertion.h_max' is 5", "a number from 1.1 to 3"});
  expect_input_error([&] { set("insertion.h_max", 0.0); }, {"'insertion.h_max' is 0"});
  expect_input_error([&] { set("insertion.rejection", 0.0); }, {"a number above 0 and at most 0.95"});
  for (const double odd : {std::nan(""), std::numeric_limits<double>::infinity()})
    expect_input_error([&] { set("optimisation.size", odd); },
                       {"'optimisation.size'", "a number, at least 0"});
  expect_input_error([&] { set("smoothing.p", 5); }, {"'smoothing.p' is 5", "14 or 16"});
  expect_input_error([&] { set("recombination.solver", 1); }, {"'recombination.solver' is 1"});
  expect_input_error([&] { set("repair.part_twins", 1); }, {"true or false"});
  expect_input_error([&] { set("recombination.solver", "lemmon"); }, {"is \"lemmon\"", "\"lemon\""});
  expect_input_error([] { Options{}.number("smoothing.p"); },
                     {"'smoothing.p' is a whole number, not a number"});
  expect_input_error([] { Options{}.flag("smooothing.p"); }, {"did you mean 'smoothing.p'?"});
}

TEST(OptionValues, NoneIsMoreThanItsMemberHolds) {
  expect_input_error([] { Options{}.set("optimisation.passes", 1LL << 40); }, {"'optimisation.passes'"});
  for (const OptionGroup& group : option_groups())
    for (const OptionKey& key : group.keys) {
      EXPECT_FALSE(key.help.empty()) << group.name << "." << key.name;
      if (!key.absent.empty()) continue;
      EXPECT_NO_THROW(Options{}.set(group.name + "." + key.name, key.value)) << group.name << "." << key.name;
    }
}

TEST(OptionGroups, FromOutsideAreCheckedLikeOthers) {
  add_options({.name = "own",
               .help = "of a test",
               .keys = {{.name = "count", .help = "how many", .value = 3, .least = 1, .most = 9},
                        {.name = "kind", .help = "which", .value = "a", .allowed = {"a", "b"}}}});
  Options options;
  EXPECT_EQ(options.integer("own.count"), 3);
  options.set("own.count", 9).set("own.kind", "b");
  EXPECT_EQ(options.text("own.kind"), "b");
  expect_input_error([&] { options.set("own.count", 10); },
                     {"'own.count' is 10", "a whole number from 1 to 9"});
  expect_input_error([&] { options.set("own.kidn", "a"); }, {"did you mean 'own.kind'?"});
}

TEST(OptionGroups, MistakesOfProgrammersAreNamed) {
  const auto refused = [](OptionGroup group, const std::string& why) {
    try {
      add_options(std::move(group));
      ADD_FAILURE() << why;
    } catch (const std::invalid_argument& error) {
      EXPECT_TRUE(holds(error.what(), why));
    }
  };
  refused({.name = "insertion"}, "already");
  refused({.name = ""}, "plain word");
  refused({.name = "a.b"}, "plain word");
  refused({.name = "twice", .keys = {{.name = "k"}, {.name = "k"}}}, "'k' stands twice");
  refused({.name = "odd", .keys = {{.name = "k", .value = 0.0, .above = 0}}}, "the default of 'k' is 0");
  refused({.name = "odd", .keys = {{.name = ""}}}, "plain word");
  for (const OptionGroup& group : option_groups()) EXPECT_TRUE(group.name != "twice" && group.name != "odd");
}

}  // namespace
}  // namespace delquad
