// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/finish/separate_duplicates.h"
#include "tests/support/meshing.h"
#include "tests/support/quad_patches.h"

namespace delquad {
namespace {

// With four to eight nodes on the circle, both caps have chords between the same two of them, or are one quad
// each. The function check_invariants() says where an edge has more than two elements or two elements have
// the same nodes.
TEST(PartTwins, CapsOnACoarseCircleShareNothingElse) {
  for (const double height : {0.45, 0.7})
    for (const double size : {5.0, 1.5, 1.2, 1.0, 0.8, 0.6}) {
      const MeshingSetup prepared =
          prepare_surface({}, make_surface_model(lens(64, 12, height)), make_constant_size(size));
      for (const char* word : {"F", "D", "DL", "FB", "DB", "PB", "DLB", "DBC", "DBCO"}) {
        SCOPED_TRACE(std::string(word) + " " + std::to_string(size) + " " + std::to_string(height));
        const MeshResult result = meshed(prepared, word);
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
      PatchSetup& patch = prepared.patches[mirrored];
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

  MeshingSetup prepared;
  std::vector<PatchMesh> patches{2};
  const std::vector<char> left_out{0, 0};
  Options options;
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
  separate_duplicates(all);
  EXPECT_EQ(patches[0].triangles.triangles, first);
  const TriPatch& separated = patches[1].triangles;
  ASSERT_EQ(separated.points.size(), 5u);
  EXPECT_EQ(separated.points[4], Vec2(0.5, 0.5));
  ASSERT_EQ(separated.triangles.size(), 4u);
  for (int t = 0; t < 4; ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = separated.triangles[t][(k + 1) % 3], b = separated.triangles[t][(k + 2) % 3];
      const int n = separated.neighbours[t][k];
      EXPECT_EQ(n < 0, a < 4 && b < 4);
      if (n < 0) continue;
      const auto& beside = separated.triangles[n];
      EXPECT_EQ(std::ranges::count(beside, a) + std::ranges::count(beside, b), 2);
    }
  separate_duplicates(all);
  EXPECT_EQ(patches[1].triangles.triangles.size(), 4u);
}

/// Each triangle's neighbors, but none across the edge of a and b.
void join(TriPatch& mesh, int a, int b) {
  const auto side = [&](int t, int k) {
    return std::minmax({mesh.triangles[t][(k + 1) % 3], mesh.triangles[t][(k + 2) % 3]});
  };
  const int n = static_cast<int>(mesh.triangles.size());
  mesh.neighbours.assign(n, {-1, -1, -1});
  for (int t = 0; t < n; ++t)
    for (int k = 0; k < 3; ++k)
      for (int u = 0; u < n; ++u)
        for (int l = 0; l < 3; ++l)
          if (t != u && side(t, k) == side(u, l) && side(t, k) != std::pair(a, b)) mesh.neighbours[t][k] = u;
}

/// A plate with a slit of one edge, on which a rib of one triangle stands.
TEST_F(Pillow, ASlitOfOneEdgeIsNoChord) {
  for (PatchMesh& patch : patches) patch.form = PatchForm::kTriangles;
  PatchBoundary& plate = prepared.patches[0].boundary;
  plate.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.25, 0.5}, {0.75, 0.5}};
  plate.edges = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 4}};
  plate.point_node = {0, 1, 2, 3, 4, 5};
  patches[0].triangles.points = plate.points;
  patches[0].triangles.n_boundary = 6;
  patches[0].triangles.triangles = {{0, 1, 5}, {0, 5, 4}, {1, 2, 5}, {4, 5, 2}, {4, 2, 3}, {0, 4, 3}};
  join(patches[0].triangles, 4, 5);
  PatchBoundary& rib = prepared.patches[1].boundary;
  rib.points = {{0, 0}, {0.5, 0}, {0.25, 1}};
  rib.edges = {{0, 1}, {1, 2}, {2, 0}};
  rib.point_node = {4, 5, 6};
  patches[1].triangles.points = rib.points;
  patches[1].triangles.n_boundary = 3;
  patches[1].triangles.triangles = {{0, 1, 2}};
  patches[1].triangles.neighbours = {{-1, -1, -1}};
  const auto before = patches[0].triangles.triangles;
  separate_duplicates(all);
  EXPECT_EQ(patches[0].triangles.triangles, before);
}

TEST_F(Pillow, OfTwoQuadsOnTheSameNodesOneGetsARing) {
  for (PatchMesh& patch : patches) patch.form = PatchForm::kQuads, patch.quads.quads = {{0, 1, 2, 3}};
  separate_duplicates(all);
  EXPECT_EQ(patches[0].quads.quads.size(), 1u);
  EXPECT_EQ(patches[1].quads.quads.size(), 5u);
  separate_duplicates(all);
  EXPECT_EQ(patches[1].quads.quads.size(), 5u);
}

/// Pairs of quads that share two sides of one node, of patches whose boundaries have the same nodes.
int two_sides_in_common(const std::vector<PatchMesh>& patches, const MeshingSetup& prepared) {
  std::set<std::array<int, 3>> corners;
  int pairs = 0;
  for (std::size_t p = 0; p < patches.size(); ++p)
    for (const auto& quad : patches[p].quads.quads)
      for (int k = 0; k < 4; ++k) {
        const auto node = [&](int i) {
          const int v = quad[i % 4], n = patches[p].quads.n_boundary;
          return v < n ? prepared.patches[p].boundary.point_node[v] : 1000 * (1 + static_cast<int>(p)) + v;
        };
        const auto [low, high] = std::minmax({node(k + 1), node(k + 3)});
        pairs += !corners.insert({node(k), low, high}).second;
      }
  return pairs;
}

TEST_F(Pillow, NoTwoQuadsShareTwoSides) {
  for (const int n : {1, 2, 5}) {
    for (const bool mirrored : {false, true}) {
      const QuadPatch grid = grid_patch(n, n);
      PatchMesh& patch = patches[mirrored];
      patch.form = PatchForm::kQuads;
      patch.quads = grid;
      PatchBoundary& boundary = prepared.patches[mirrored].boundary;
      boundary = shapes::rectangle(n, n, n, n);
      // The other side of the pillow runs round the other way.
      if (mirrored)
        for (int i = 0; i < 4 * n; ++i) boundary.point_node[i] = (4 * n - i) % (4 * n);
    }
    EXPECT_GT(two_sides_in_common(patches, prepared), 0) << n;
    const SeparationSummary summary = separate_duplicates(all);
    EXPECT_EQ(two_sides_in_common(patches, prepared), 0) << n;
    EXPECT_EQ(summary.corners_left, 0) << n;
    for (const PatchMesh& patch : patches) EXPECT_TRUE(check_invariants(QuadTopology(patch.quads)).empty());
  }
}

/// A cut ends at a corner of the patch: both its sides are one edge in space, which one quad would have
/// twice.
TEST_F(Pillow, NoQuadHasBothSidesOfACut) {
  prepared.patches.resize(1);
  patches.resize(1);
  patches[0].form = PatchForm::kQuads;
  patches[0].quads = grid_patch(3, 3);
  PatchBoundary& boundary = prepared.patches[0].boundary;
  boundary = shapes::rectangle(3, 3, 3, 3);
  boundary.point_node.back() = boundary.point_node[1];
  const auto quads_at_the_end = [&] {
    return std::ranges::count_if(patches[0].quads.quads,
                                 [](const auto& quad) { return std::ranges::find(quad, 0) != quad.end(); });
  };
  ASSERT_EQ(quads_at_the_end(), 1);
  EXPECT_EQ(separate_duplicates(all).corners_left, 0);
  EXPECT_EQ(quads_at_the_end(), 2);
  EXPECT_TRUE(check_invariants(QuadTopology(patches[0].quads)).empty());
}

}  // namespace
}  // namespace delquad
