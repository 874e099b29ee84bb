// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/compound.h"
#include "io/mesh_io.h"
#include "tests/support/meshing.h"
#include "tests/support/shared_data.h"
#include "tests/support/surface_model_checks.h"

namespace delquad {
namespace {

const std::vector<std::string> kSoundShared;

TEST(SharedTriangulations, FandiskHasTwelveFaces) {
  const auto file = shared_data("fandisk.off");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "data not found: " << file;
  const Mesh mesh = read_mesh(file);
  const SurfaceModel model = make_surface_model(mesh);
  EXPECT_EQ(violations(model), kSoundShared);
  EXPECT_EQ(model.fine.regions.size(), 12u);
  EXPECT_EQ(model.fine.curves.size(), 32u);
  EXPECT_EQ(model.corners.size(), 22u);
  EXPECT_TRUE(model.warnings.empty());
}

TEST(SharedTriangulations, BunnyIsClosedAndFacesOutwards) {
  const auto file = shared_data("bunny_adaptive.off");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "data not found: " << file;
  const Mesh mesh = read_mesh(file);
  const SurfaceModel model = make_surface_model(mesh, {.feature_angle = 90});
  EXPECT_EQ(violations(model), kSoundShared);
  EXPECT_EQ(model.fine.regions.size(), 1u);
  EXPECT_TRUE(model.fine.lines.empty());
  EXPECT_GT(volume(model.fine), 0);
}

TEST(SharedTriangulations, FalconHangsTogetherOnceItsGapsAreWelded) {
  const auto file = shared_data("falcon_half.msh");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "data not found: " << file;
  const Mesh mesh = read_mesh(file);
  const SurfaceModel torn = make_surface_model(mesh);
  EXPECT_EQ(torn.fine.regions.size(), 15u);
  EXPECT_EQ(tangent_groups(torn, 180).size(), 3u);

  const SurfaceModel whole = make_surface_model(mesh, {.weld_tolerance = 1e-5});
  EXPECT_EQ(violations(whole), kSoundShared);
  EXPECT_EQ(whole.fine.regions.size(), 15u);
  EXPECT_EQ(whole.fine.curves.size(), 32u);
  const auto groups = tangent_groups(whole, 180);
  ASSERT_EQ(groups.size(), 1u);
  EXPECT_EQ(groups[0].size(), 15u);
  const SurfaceModel one = make_compound(whole, groups);
  EXPECT_EQ(violations(one), kSoundShared);
  // What is left over is the cut through the plane of symmetry.
  for (const auto& line : one.fine.lines) {
    for (const int p : line) EXPECT_NEAR(one.fine.points[p].z, 0.272342, 2e-3);
  }
}

}  // namespace
}  // namespace delquad
