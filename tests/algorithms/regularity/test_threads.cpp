#include <gtest/gtest.h>

#include <functional>

#include "algorithms/cleanup/cleanup.h"
#include "algorithms/regularity/regularity.h"
#include "algorithms/treatment/treatment.h"
#include "base/context.h"
#include "tests/support/analytic_fields.h"
#include "tests/support/quad_patch_checks.h"
#include "tests/support/quad_patches.h"

namespace delquad {
namespace {

using namespace testing_support;

constexpr int kWide = 220, kHigh = 190;  ///< three blocks

/// Works on a large mesh with several numbers of threads: always the same, sound, mesh.
QuadPatch expect_same(const QuadPatch& mesh, const std::function<QuadPatch(const QuadPatch&)>& work) {
  QuadPatch first;
  for (const int threads : {1, 2, 7}) {
    const RunScope run({.threads = threads});
    const QuadPatch result = work(mesh);
    if (threads == 1) first = result;
    EXPECT_EQ(result.points, first.points) << threads;
    EXPECT_EQ(result.quads, first.quads) << threads;
  }
  expect_sound(first, shapes::rectangle(kWide, kHigh, kWide, kHigh));
  return first;
}

int irregular(const QuadPatch& mesh) {
  const QuadTopology topology(mesh);
  int n = 0;
  for (int v = mesh.n_boundary; v < topology.vertex_slots(); ++v) n += topology.valence(v) != 4;
  return n;
}

TEST(Threads, SameTreatmentCleanupAndRegularity) {
  const QuadPatch mesh = scrambled(grid_patch(kWide, kHigh), 5, 450);
  const FunctionSize size(1);
  const QuadPatch treated = expect_same(mesh, [&](const QuadPatch& m) { return treat_paper(m, size); });
  EXPECT_LT(irregular(treated), irregular(mesh));
  CleanupSummary summary;
  const QuadPatch cleaned =
      expect_same(treated, [&](const QuadPatch& m) { return clean_up(m, size, {}, &summary); });
  EXPECT_LT(irregular(cleaned), irregular(treated));
  EXPECT_EQ(summary.irregular_after, irregular(cleaned)) << "the boundary has none";
  const QuadPatch regular = expect_same(treated, [&](const QuadPatch& m) { return make_regular(m, size); });
  EXPECT_LT(irregular(regular), irregular(treated));
}

}  // namespace
}  // namespace delquad
