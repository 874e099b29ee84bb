#include "pipeline/part_twins.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "fields/fields.h"
#include "geometry/surface/triangulated_model.h"
#include "pipeline/prepare_surface.h"
#include "pipeline/runner.h"
#include "tests/support/triangulated_shapes.h"

namespace delquad {
namespace {

// With four to eight nodes on the circle both caps have chords between the same two of them, or are one quad
// each. check_invariants() says where an edge has more than two elements or two elements have the same nodes.
TEST(PartTwins, CapsOnACoarseCircleShareNothingElse) {
  Case c;
  c.name = c.where = "lens";
  for (const double height : {0.45, 0.7})
    for (const double size : {5.0, 1.5, 1.2, 1.0, 0.8, 0.6}) {
      const PreparedCase prepared =
          prepare_surface(c, make_surface_model(testing_support::lens(64, 12, height)),
                          make_constant_size(size), [](double) {});
      for (const char* word : {"F", "D", "DL", "FB", "DB", "PB", "DLB", "DBC", "DBCO"}) {
        SCOPED_TRACE(std::string(word) + " " + std::to_string(size) + " " + std::to_string(height));
        Progress progress;
        const RunResult result = run_word(c, prepared, parse_word(word), progress);
        EXPECT_EQ(check_invariants(result.mesh), std::vector<std::string>{});
        EXPECT_EQ(result.surface->mesh.euler_characteristic, 2);
        EXPECT_TRUE(result.surface->mesh.watertight());
      }
    }
}

/// Two faces of two triangles or one quad each on the same four nodes, as a pillow has.
class Pillow : public testing::Test {
 protected:
  Pillow() {
    prepared.patches.resize(2);
    for (const bool mirrored : {false, true}) {
      PreparedPatch& patch = prepared.patches[mirrored];
      patch.boundary.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
      patch.boundary.point_node = mirrored ? std::vector<int>{1, 0, 3, 2} : std::vector<int>{0, 1, 2, 3};
      patch.size = std::make_shared<UniformSize>();
      patches[mirrored].quads.points = patches[mirrored].triangles.points = patch.boundary.points;
      patches[mirrored].quads.n_boundary = patches[mirrored].triangles.n_boundary = 4;
    }
  }

  struct UniformSize : ParametricSize {
    double at(Vec2, int&) const override { return 0.5; }
  };

  PreparedCase prepared;
  std::vector<PatchMesh> patches{2};
  const std::vector<char> left_out{0, 0};
  MeshingOptions options;
  SurfaceNodes nodes;
  const AllPatches all{prepared, options, patches, left_out, nodes};
};

TEST_F(Pillow, AChordBetweenTheSameNodesIsPartedInOneOfThem) {
  for (PatchMesh& patch : patches) patch.form = PatchForm::kTriangles;
  patches[0].triangles.triangles = {{0, 1, 2}, {0, 2, 3}};
  patches[0].triangles.neighbours = {{-1, 1, -1}, {-1, -1, 0}};
  patches[1].triangles.triangles = {{0, 1, 3}, {1, 2, 3}};
  patches[1].triangles.neighbours = {{1, -1, -1}, {-1, 0, -1}};
  const auto first = patches[0].triangles.triangles;
  part_twins(all);
  EXPECT_EQ(patches[0].triangles.triangles, first);
  const TriPatch& parted = patches[1].triangles;
  ASSERT_EQ(parted.points.size(), 5u);
  EXPECT_EQ(parted.points[4], Vec2(0.5, 0.5));
  ASSERT_EQ(parted.triangles.size(), 4u);
  for (int t = 0; t < 4; ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = parted.triangles[t][(k + 1) % 3], b = parted.triangles[t][(k + 2) % 3];
      const int n = parted.neighbours[t][k];
      EXPECT_EQ(n < 0, a < 4 && b < 4);
      if (n < 0) continue;
      const auto& beside = parted.triangles[n];
      EXPECT_EQ(std::ranges::count(beside, a) + std::ranges::count(beside, b), 2);
    }
  part_twins(all);
  EXPECT_EQ(patches[1].triangles.triangles.size(), 4u);
}

TEST_F(Pillow, OfTwoQuadsOnTheSameNodesOneGetsARing) {
  for (PatchMesh& patch : patches) patch.form = PatchForm::kQuads, patch.quads.quads = {{0, 1, 2, 3}};
  part_twins(all);
  EXPECT_EQ(patches[0].quads.quads.size(), 1u);
  EXPECT_EQ(patches[1].quads.quads.size(), 5u);
  part_twins(all);
  EXPECT_EQ(patches[1].quads.quads.size(), 5u);
}

}  // namespace
}  // namespace delquad
