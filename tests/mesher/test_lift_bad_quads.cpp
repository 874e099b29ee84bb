#include "algorithms/finish/lift_bad_quads.h"

#include <gtest/gtest.h>

#include <random>

#include "fields/fields.h"
#include "mesher/finish_steps.h"
#include "mesher/prepare.h"
#include "mesher/runner.h"
#include "tests/support/prepare_surface.h"
#include "tests/support/shapes.h"
#include "tests/support/surfaces.h"

namespace delquad {
namespace {

namespace surfaces = testing_support;

/// A ball with noise: bends sharper than any size, and no curve along them.
SurfaceModel rough_ball(int seed, double noise) {
  SurfaceModel model = surfaces::round_sphere(5);
  std::mt19937_64 random(seed);
  for (Vec3& p : model.fine.points) p = (1 + noise * (2 * shapes::uniform(random) - 1)) * p;
  return model;
}

TEST(LiftBadQuads, RingsHelpWhereMovingDoesNot) {
  double rings = 0;
  for (int seed = 0; seed < 8; ++seed) {
    MeshProblem c;
    c.name = c.where = "ball";
    c.options.set("curves.agreement", 0);  // with it, they are not needed
    const PreparedProblem prepared =
        surfaces::prepare_surface(c, rough_ball(seed, 0.2), make_constant_size(0.4));
    const MeshResult result = run_word(prepared, parse_word("DB"));
    rings += result.log.summaries.number("lift_bad_quads", "rings");
    EXPECT_TRUE(result.soundness.sound()) << seed << ": " << result.soundness.text();
  }
  EXPECT_GT(rings, 0);
}

TEST(LiftBadQuads, ChangesHelpWhereRingsDoNot) {
  double mended = 0;
  for (const int seed : {0, 2, 3, 4, 5}) {  // 1, 6 and 7 need smaller sizes
    MeshProblem c;
    c.name = c.where = "ball";
    const PreparedProblem prepared =
        surfaces::prepare_surface(c, rough_ball(seed, 0.3), make_constant_size(0.7));
    const MeshResult result = run_word(prepared, parse_word("DB"));
    mended += result.log.summaries.number("lift_bad_quads", "mended");
    EXPECT_TRUE(result.soundness.sound()) << seed << ": " << result.soundness.text();
  }
  EXPECT_GT(mended, 0);
}

TEST(LiftBadQuads, SaysWhatItWasWorth) {
  using Pairs = std::vector<std::vector<double>>;
  MeshProblem c;
  c.name = c.where = "ball";
  const PreparedProblem prepared = surfaces::prepare_surface(c, rough_ball(0, 0.2), make_constant_size(0.4));
  const MeshResult run = run_word(prepared, parse_word("DB"));
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
