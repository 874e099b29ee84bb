// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/volume/fill_steps.h"

#include "tests/features/volume/volume_checks.h"

namespace delquad::testing_support {
namespace {

/// Three quads around a gap whose ends are triangles.
Mesh gap() {
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0.5, 0.8, 0}, {0, 0, 1}, {1, 0, 1}, {0.5, 0.8, 1}};
  mesh.quads = {{1, 4, 3, 0}, {1, 2, 5, 4}, {0, 3, 5, 2}};
  return mesh;
}

TEST(PlacePrisms, FillsGapsBetweenThreeQuads) {
  Mesh mesh = gap();
  place_prisms(mesh);
  ASSERT_EQ(mesh.prisms.size(), 1u);
  EXPECT_EQ(mesh.prism_volume.size(), 1u);
  EXPECT_NEAR(measure(mesh).volume, 0.4, 1e-12);
  EXPECT_GT(measure(mesh).least_jacobian, 0.8);
}

TEST(PlacePrisms, LeavesOthers) {
  Mesh inverted = gap();
  for (auto& quad : inverted.quads) std::swap(quad[1], quad[3]);
  Mesh flat = gap();
  flat.points[2].y = flat.points[5].y = 0.01;
  Mesh open = gap();
  open.quads.pop_back();
  Mesh crossed = gap();
  crossed.points.insert(crossed.points.end(),
                        {{0.5, 0.3, -1}, {0.5, 0.4, -1}, {0.5, 0.4, 0.5}, {0.5, 0.3, 0.5}});
  crossed.quads.push_back({6, 7, 8, 9});
  for (Mesh* mesh : {&inverted, &flat, &open, &crossed}) {
    place_prisms(*mesh);
    EXPECT_TRUE(mesh->prisms.empty());
  }
}

}  // namespace
}  // namespace delquad::testing_support
