// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/finish/edit_failing.h"
#include "algorithms/finish/lift_bad_quads.h"
#include "geometry/mesh/quad_corners.h"
#include "mesher/finish_steps.h"
#include "metrics/judgement/criteria.h"
#include "metrics/judgement/poor_quads.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

/// A ball with noise: bends sharper than any size, and no curve along them.
SurfaceModel rough_ball(int seed, double noise) {
  SurfaceModel model = round_sphere(5);
  std::mt19937_64 random(seed);
  for (Vec3& p : model.fine.points) p = (1 + noise * (2 * shapes::uniform(random) - 1)) * p;
  return model;
}

TEST(LiftBadQuads, RingsHelpWhereMovingDoesNot) {
  double rings = 0;
  for (int seed = 0; seed < 8; ++seed) {
    MeshProblem c;
    c.options.set("curves.agreement", 0);  // with it, they are not needed
    const MeshResult result = meshed(rough_ball(seed, 0.2), 0.4, "DB", c);
    rings += result.log.summaries.number("lift_bad_quads", "rings");
    EXPECT_TRUE(result.soundness.sound()) << seed << ": " << result.soundness.text();
  }
  EXPECT_GT(rings, 0);
}

TEST(LiftBadQuads, ChangesHelpWhereRingsDoNot) {
  double repaired = 0;
  for (const int seed : {0, 2, 3, 4, 5}) {  // 1, 6 and 7 need smaller sizes
    const MeshResult result = meshed(rough_ball(seed, 0.3), 0.7, "DB");
    repaired += result.log.summaries.number("lift_bad_quads", "mended");
    EXPECT_TRUE(result.soundness.sound()) << seed << ": " << result.soundness.text();
  }
  EXPECT_GT(repaired, 0);
}

TEST(LiftBadQuads, EndsAtABudgetThatGrowsWithTheQuads) {
  const MeshResult result = meshed(rough_ball(1, 0.8), 1.2, "DB");
  EXPECT_LT(result.lifting_cost, 550'000 + 300 * std::ssize(result.mesh.quads));
}

/// A roof without a curve on its ridge, which runs askew to the rows of quads.
SurfaceModel roof(double skew, double slope) {
  return grid_surface({40, 40}, [=](double u, double v) {
    const double x = 2 * u - 1;
    return Vec3{x + skew * (2 * v - 1) * (1 - x * x), 2 * v - 1, -slope * std::abs(x)};
  });
}

Criteria batch() { return *std::ranges::find(criteria_presets(), "batch", &Criteria::name); }

// O does not know of warpage, and where faces bend sharply no slope leads to what is flatter.
TEST(RepairFailingQuads, MovesLeaveFewer) {
  double before = 0, after = 0;
  for (const double skew : {0.1, 0.2, 0.3, 0.4})
    for (const double h : {0.1, 0.13, 0.17}) {
      SCOPED_TRACE(testing::Message() << skew << ' ' << h);
      MeshProblem c;
      c.criteria = batch();
      const auto run = [&](bool repairs) {
        c.options.set("repair.failing_quads", repairs);
        const MeshingSetup prepared = prepare_surface(c, roof(skew, 0.7), make_constant_size(h));
        const MeshResult result = meshed(prepared, "DBCO");
        (repairs ? after : before) += failing_part(prepared, result.mesh);
        return std::pair(result.metrics.values.at("eta_mean"), result.metrics.values.at("eta_worst"));
      };
      const auto [mean, worst] = run(false);
      const auto [repaired_mean, repaired_worst] = run(true);
      EXPECT_GE(repaired_worst, std::min(worst, QuadLimits{}.eta) - 1e-9);
      EXPECT_GE(repaired_mean, mean - 0.02);
    }
  EXPECT_GT(before, 0.1);
  EXPECT_LT(after, before / 2);
}

TEST(RepairFailingQuads, NothingIsDoneWithoutCriteria) {
  for (const bool has_criteria : {false, true}) {
    MeshProblem c;
    if (has_criteria) c.criteria = batch();
    const MeshResult result = meshed(roof(0.3, 0.7), 0.13, "DBCO", c);
    const Summaries& done = result.log.summaries;
    EXPECT_TRUE(done.has("lift_bad_quads"));
    EXPECT_EQ(done.has("failing_quads") && done.number("failing_quads", "moved") > 0, has_criteria);
    EXPECT_EQ(result.criteria.has_value(), has_criteria);
  }
}

/// Corners of the boundary with one quad, and sides inside between two of its points: other faces may have
/// these, too.
int ties(const QuadPatch& mesh) {
  const QuadTopology topology(mesh);
  int n = 0;
  for (int v = 0; v < mesh.n_boundary; ++v) {
    n += topology.valence(v) == 1;
    topology.for_each_out(
        v, [&](int h) { n += topology.twin(h) >= 0 && topology.on_boundary(topology.target(h)); });
  }
  return n;
}

/// A spike without a tip.
SurfaceModel spike() {
  return grid_surface({40, 40}, [](double u, double v) {
    return Vec3{(2 * u - 1) * (1 - 0.9 * v), 4 * v, 0.2 * v * v};
  });
}

// Where moves do not do: words without C and O leave much that fails.
TEST(RepairFailingQuads, EditsLeaveFewer) {
  const Pipeline word = parse_pipeline("DB");
  double before = 0, after = 0;
  int edits = 0;
  for (const double h : {0.11, 0.13, 0.17, 0.19, 0.23}) {
    SCOPED_TRACE(h);
    MeshProblem c;
    c.criteria = batch();
    const std::shared_ptr<const SizeField> size = make_constant_size(h);
    const MeshingSetup prepared = prepare_surface(c, spike(), size);
    PipelineState state = begin_meshing(prepared);
    for (const Stage* stage : word.stages) run_stage(*stage, prepared, state);
    const std::vector<char> none(state.patches.size(), 0);
    const AllPatches all{prepared, prepared.settings.options, state.patches, none, state.nodes};
    place_inside(all);
    const auto failing = [&] {
      return failing_part(prepared, assemble(prepared, state.nodes.points, state.patches, none));
    };
    for (std::size_t p = 0; p < state.patches.size(); ++p) {
      const double was = failing();
      const int tied = ties(state.patches[p].quads);
      edits += edit_failing(all, p, {*size, {}, excess_of(batch())});
      EXPECT_LE(failing(), was);
      EXPECT_LE(ties(state.patches[p].quads), tied);
      before += was, after += failing();
    }
    EXPECT_TRUE(
        check_elements(prepared, assemble(prepared, state.nodes.points, state.patches, none)).sound());
  }
  EXPECT_GT(edits, 5);
  EXPECT_LT(after, 0.8 * before);
}

TEST(RepairFailingQuads, OfAGivenMeshToo) {
  double before = 0, after = 0;
  for (const double h : {0.13, 0.17, 0.19, 0.23}) {
    MeshProblem c;
    c.options.set("repair.lift_bad_quads", false);
    MeshProblem given = problem_of(GivenMesh{meshed(spike(), h, "DB", c).mesh}, h);
    given.criteria = batch();
    const auto failing = [&](bool repairs) {
      given.options.set("repair.failing_quads", repairs);
      const MeshingSetup prepared = prepare_problem(given);
      const MeshResult result = run_pipeline(prepared, parse_pipeline("CO", PipelineStart::kGivenMesh));
      EXPECT_TRUE(result.soundness.sound());
      return failing_part(prepared, result.mesh);
    };
    before += failing(false);
    after += failing(true);
  }
  EXPECT_GT(before, 0.01);
  EXPECT_LT(after, 0.8 * before);
}

TEST(LiftBadQuads, SaysWhatItTook) {
  const Summaries done = meshed(rough_ball(0, 0.2), 0.4, "DB").log.summaries;
  EXPECT_GT(done.number("lift_bad_quads", "moved"), 0);
  double seconds = 0;
  for (const FinishStep& step : finish_steps())
    if (done.has(step.name)) seconds += done.number(step.name, "seconds");
  EXPECT_NEAR(done.number("finish", "seconds"), seconds, 1e-9);
}

}  // namespace
}  // namespace delquad
