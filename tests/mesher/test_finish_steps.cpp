#include <gtest/gtest.h>

#include "geometry/surface/triangulated_model.h"
#include "mesher/finish_steps.h"
#include "mesher/prepare_surface.h"
#include "tests/support/triangulated_shapes.h"

namespace delquad {
namespace {

using Pairs = std::vector<std::vector<double>>;

RunResult lens(const Options& options) {
  MeshProblem problem;
  problem.name = problem.where = "lens";
  problem.options = options;
  const PreparedProblem prepared =
      prepare_surface(problem, make_surface_model(testing_support::lens(64, 12, 0.45)),
                      make_constant_size(0.3), [](double) {});
  return run_word(prepared, parse_word("DBC"));
}

TEST(FinishSteps, EachIsSwitchedOffByItsOwnOption) {
  const RunResult all = lens({});
  int n_ran = 0;
  for (const FinishStep& step : finish_steps()) {
    if (step.option == nullptr || !all.log.summaries.has(step.name)) continue;
    ++n_ran;
    const RunResult without = lens(Options().set(std::string("repair.") + step.name, false));
    for (const FinishStep& other : finish_steps())
      EXPECT_EQ(without.log.summaries.has(other.name),
                all.log.summaries.has(other.name) && other.name != std::string(step.name))
          << step.name << " " << other.name;
  }
  EXPECT_GE(n_ran, 2);
}

TEST(FinishSteps, TellWhatTheyWereWorth) {
  const RunResult run = lens({});
  const Summaries& done = run.log.summaries;
  ASSERT_GT(done.number("lift_bad_quads", "moved"), 0);
  const auto& lifted = done.get<Pairs>("lift_bad_quads", "eta_mean");
  ASSERT_EQ(lifted.size(), 1u);
  // Nothing comes after it.
  EXPECT_EQ(lifted[0][1], run.metrics.values.at("eta_mean"));
  EXPECT_EQ(done.get<Pairs>("lift_bad_quads", "eta_worst")[0][1], run.metrics.values.at("eta_worst"));
  EXPECT_EQ(done.get<Pairs>("lift_bad_quads", "irregular")[0][1], run.metrics.values.at("n_irregular"));
  EXPECT_GT(done.get<Pairs>("lift_bad_quads", "eta_worst")[0][1],
            done.get<Pairs>("lift_bad_quads", "eta_worst")[0][0]);
  double gain = 0, seconds = 0;
  for (const FinishStep& step : finish_steps()) {
    const SummaryStep* of_step = done.find(step.name);
    if (of_step == nullptr) continue;
    seconds += done.number(step.name, "seconds");
    if (of_step->find("eta_mean") == nullptr) continue;
    for (const auto& pair : done.get<Pairs>(step.name, "eta_mean")) gain += pair[1] - pair[0];
  }
  EXPECT_NEAR(done.number("finish", "eta_mean"), gain, 1e-12);
  EXPECT_NEAR(done.number("finish", "seconds"), seconds, 1e-9);
}

}  // namespace
}  // namespace delquad
