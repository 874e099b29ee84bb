#include <gtest/gtest.h>

#include "geometry/surface/triangulated_model.h"
#include "mesher/finish_steps.h"
#include "mesher/prepare.h"
#include "tests/support/triangulated_shapes.h"

namespace delquad {
namespace {

MeshResult lens(const Options& options) {
  MeshProblem problem;
  problem.name = problem.where = "lens";
  problem.options = options;
  const PreparedProblem prepared =
      prepare_surface(problem, make_surface_model(testing_support::lens(64, 12, 0.45)),
                      make_constant_size(0.3), [](double) {});
  return run_word(prepared, parse_word("DBC"));
}

TEST(FinishSteps, EachIsSwitchedOffByItsOwnOption) {
  const MeshResult all = lens({});
  int n_ran = 0;
  for (const FinishStep& step : finish_steps()) {
    if (step.option == nullptr || !all.log.summaries.has(step.name)) continue;
    ++n_ran;
    const MeshResult without = lens(Options().set(std::string("repair.") + step.name, false));
    for (const FinishStep& other : finish_steps())
      EXPECT_EQ(without.log.summaries.has(other.name),
                all.log.summaries.has(other.name) && other.name != std::string(step.name))
          << step.name << " " << other.name;
  }
  EXPECT_GE(n_ran, 2);
}

}  // namespace
}  // namespace delquad
