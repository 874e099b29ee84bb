// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/finish_steps.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

MeshingSetup prepared_lens(const Options& options, const Criteria& criteria = {}) {
  MeshProblem problem;
  problem.criteria = criteria;
  problem.options = options;
  return prepare_surface(problem, make_surface_model(lens(64, 12, 0.45)), make_constant_size(0.3));
}

MeshResult finished_lens(const Options& options) { return meshed(prepared_lens(options), "DBC"); }

TEST(FinishSteps, EachIsSwitchedOffByItsOwnOption) {
  const MeshResult all = finished_lens({});
  int n_ran = 0;
  for (const FinishStep& step : finish_steps()) {
    if (step.option == nullptr || !all.log.summaries.has(step.name)) continue;
    ++n_ran;
    const MeshResult without = finished_lens(Options().set(std::string("repair.") + step.name, false));
    for (const FinishStep& other : finish_steps())
      EXPECT_EQ(without.log.summaries.has(other.name),
                all.log.summaries.has(other.name) && other.name != std::string(step.name))
          << step.name << " " << other.name;
  }
  EXPECT_GE(n_ran, 2);
}

TEST(BetterMesh, FailingQuadsCountBeforeRegularityAndShapes) {
  const MeshingSetup prepared = prepared_lens({});
  const MeshResult before = meshed(prepared, "DBC");
  MeshResult after = before;
  after.metrics.values.at("n_irregular") -= 2;
  after.metrics.values.at("eta_mean") += 0.01;
  EXPECT_TRUE(is_more_regular(prepared, after, before));
  EXPECT_TRUE(is_better(prepared, after, before));
  // The last point, which is inside of a face, comes near to another.
  const auto at = std::ranges::find_if(after.mesh.quads, [&](const auto& quad) {
    return quad[0] + 1 == static_cast<int>(after.mesh.points.size());
  });
  ASSERT_NE(at, after.mesh.quads.end());
  Vec3& x = after.mesh.points.back();
  x = x + 0.8 * (after.mesh.points[(*at)[1]] - x);
  EXPECT_TRUE(is_better(prepared, after, before)) << "without criteria no quad fails";
  const MeshingSetup judged = prepared_lens({}, read_criteria("batch"));
  EXPECT_FALSE(is_more_regular(judged, after, before));
  EXPECT_FALSE(is_better(judged, after, before));
}

}  // namespace
}  // namespace delquad
