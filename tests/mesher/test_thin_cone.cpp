// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"

namespace delquad {
namespace {

// Treatment and clean-up do not know that a cut is the same on both sides: what they leave must
// not be only two quads around.
TEST(ThinCone, AtLeastThreeQuadsStayAround) {
  for (const double half_angle : {0.025, 0.05})
    for (const double size : {1.0 / 43, 1.0 / 60})
      for (const char* word : {"DB", "DBC"}) {
        const MeshResult result = mesh(problem_of(TriangleModel{cone(24, 100, half_angle).fine}, size), word);
        EXPECT_TRUE(result.mesh.triangles.empty());
        EXPECT_EQ(check_invariants(result.mesh), std::vector<std::string>{});
        EXPECT_EQ(result.surface->nonconforming_edges.count, 0) << half_angle << " " << size << " " << word;
      }
}

// The wall of a drilled hole and its tip, of 118 degrees. The rim of the wall has no more edges than the size
// asks for: 14 irregular vertices once, at a tau of 65.
TEST(ThinCone, ADrilledTipAsksForNoSmallSizes) {
  const double slant = 1 / std::sin(59 * std::numbers::pi / 180);
  const Mesh hole = grid_surface({36, 30, true, false, true}, [&](double u, double v) {
                      const double phi = 2 * std::numbers::pi * u, r = std::min(1.0, 5 * v);
                      const double z = v < .2 ? -r * std::sqrt(slant * slant - 1)
                                              : 10 * (0.2 - v) - std::sqrt(slant * slant - 1);
                      return Vec3{r * std::cos(phi), r * std::sin(phi), z};
                    }).fine;
  for (const double size : {1.0, 0.7, 0.5}) {
    const MeshResult result = mesh(problem_of(TriangleModel{hole}, size), "DBCQO");
    EXPECT_LE(result.metrics.values.at("n_irregular"), 6) << size;
    EXPECT_GT(result.metrics.values.at("tau"), 90) << size;
  }
}

}  // namespace
}  // namespace delquad
