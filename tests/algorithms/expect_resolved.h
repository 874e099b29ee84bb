#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "algorithms/insertion/frontal_mesher.h"
#include "geometry/mesh/constrained_delaunay.h"
#include "tests/support/patch_invariants.h"

namespace delquad::testing_support {

/// What holds wherever insertion has come to its end, for a size that varies by less than a third along an
/// edge: edges to inserted points keep the rejection distance.
inline void expect_resolved(const TriPatch& tri, const PatchBoundary& boundary, const ParametricSize& size,
                            const FrontalOptions& options, const FrontalSummary& summary) {
  ASSERT_TRUE(check_invariants(tri).empty());
  ASSERT_EQ(summary.termination, FrontalTermination::kResolved);
  ASSERT_EQ(summary.inserted + static_cast<long long>(boundary.points.size()),
            static_cast<long long>(tri.points.size()));
  ASSERT_TRUE(std::equal(boundary.points.begin(), boundary.points.end(), tri.points.begin()));
  for (const auto& t : tri.triangles) {
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      if (std::max(a, b) < tri.n_boundary) continue;
      int hint = -1;
      EXPECT_GT(norm(tri.points[a] - tri.points[b]), 0.6 * options.rejection * size.at(tri.points[b], hint));
    }
  }
}

}  // namespace delquad::testing_support
