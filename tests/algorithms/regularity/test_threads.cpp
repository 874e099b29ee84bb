// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/algorithms/stages.h"

namespace delquad {
namespace {

constexpr int kWide = 220, kHigh = 190;  ///< three blocks

/// Works on a large mesh with several numbers of threads: always the same, sound, mesh.
QuadPatch expect_same(const QuadPatch& mesh, const std::function<QuadPatch(const QuadPatch&)>& work) {
  QuadPatch result;
  on_threads({1, 2, 7}, [&] {
    result = work(mesh);
    return std::pair(result.points, result.quads);
  });
  expect_sound(result, shapes::rectangle(kWide, kHigh, kWide, kHigh));
  return result;
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
  RegularitySummary summary;
  const QuadPatch cleaned = expect_same(
      treated, [&](const QuadPatch& m) { return make_regular(m, size, without_price({}), &summary); });
  EXPECT_LT(irregular(cleaned), irregular(treated));
  EXPECT_EQ(summary.irregular_after, irregular(cleaned)) << "the boundary has none";
  const QuadPatch regular = expect_same(treated, [&](const QuadPatch& m) { return make_regular(m, size); });
  EXPECT_LT(irregular(regular), irregular(treated));
}

}  // namespace
}  // namespace delquad
