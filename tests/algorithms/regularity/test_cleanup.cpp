// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/algorithms/stages.h"

namespace delquad {
namespace {

/// Boundary vertices whose only quad has an angle of about 160 degrees or more.
int forced_bad(const QuadPatch& mesh) {
  const QuadTopology topology(mesh);
  const ValenceEnergy energy(topology);
  int bad = 0;
  for (int v = 0; v < mesh.n_boundary; ++v) bad += topology.valence(v) == 1 && energy.of(v) > 7;
  return bad;
}

TEST(ValenceEnergy, ForcedElementsCostMore) {
  // One quad with a boundary angle of 180 - 2a at its first corner.
  const auto of_corner = [](double degrees, int valence) {
    const double half = degrees / 2 * std::numbers::pi / 180;
    QuadPatch quad;
    quad.points = {{0, 0}, {std::sin(half), std::cos(half)}, {0, 2}, {-std::sin(half), std::cos(half)}};
    quad.quads = {{0, 1, 2, 3}};
    quad.n_boundary = 4;
    const QuadTopology topology(quad);
    return ValenceEnergy(topology).of(0, valence);
  };
  EXPECT_EQ(of_corner(90, 1), 0);
  EXPECT_EQ(of_corner(90, 2), 1);     // 45 degrees each: eta 1/2 is none too bad
  EXPECT_EQ(of_corner(134, 1), 0);    // ideal
  EXPECT_EQ(of_corner(136, 1), 2);    // eta 0.49
  EXPECT_EQ(of_corner(157.5, 1), 7);  // eta 1/4: half of 12, and one step of valence
  EXPECT_EQ(of_corner(157.5, 2), 0);
  EXPECT_EQ(of_corner(179.99, 1), 13);
  EXPECT_EQ(of_corner(20, 1), 0);  // the best there is
  EXPECT_EQ(of_corner(20, 2), 4);  // 10 for an eta of 1/9 in place of 7 for 2/9, and one step
}

TEST(ValenceEnergy, GainIsWhatTheSumLoses) {
  // On this the end of the queues of moves rests.
  std::vector<QuadPatch> meshes = {scrambled(grid_patch(8, 7), 3, 30)};
  for (int seed = 0; seed < 20; ++seed) meshes.push_back(scrambled(grid_patch(8, 8), seed, 100));
  for (const QuadPatch& mesh : meshes) {
    QuadTopology topology(mesh);
    const ValenceEnergy energy(topology);
    const int before = valence_energy(topology, energy);
    std::array<int, 8> tried{};
    const auto check = [&](const TreatmentMove& move) {
      if (!is_legal(topology, move)) return;
      const int gain = energy.gain(move);
      const auto start = topology.mark();
      apply(topology, move);
      EXPECT_EQ(before - valence_energy(topology, energy), gain) << "kind " << move.kind << " at " << move.at;
      topology.rollback(start);
      ++tried[move.kind];
    };
    for (int e = 0; e < topology.element_slots(); ++e) {
      for_each_move(topology, e, check);
      for_each_opening(topology, e, check);
    }
    for (int v = 0; v < topology.vertex_slots(); ++v) for_each_split(topology, v, check);
    using Move = TreatmentMove;
    for (const auto kind : {Move::kRotateForward, Move::kRotateBackward, Move::kCollapse, Move::kSplit,
                            Move::kOpenForward, Move::kOpenBackward})
      EXPECT_GT(tried[kind], 10) << "kind " << kind;
  }
}

TEST(Cleanup, ScrambledGridRecovers) {
  for (int seed = 0; seed < 5; ++seed) {
    const QuadPatch mesh = scrambled(grid_patch(16, 16), seed, 60);
    ASSERT_LT(worst_sine(mesh), 0.01);
    const QuadPatch result = cleaned(mesh, shapes::rectangle(16, 16, 16, 16), FunctionSize(1));
    EXPECT_GT(worst_sine(result), sine_of_eta(0.3)) << "seed " << seed;
    EXPECT_LT(valence_energy(result), valence_energy(mesh) / 4) << "seed " << seed;
  }
}

TEST(Cleanup, DoubletGoes) {
  const QuadPatch result = cleaned(doublet(), shapes::rectangle(2, 2, 1, 1), FunctionSize(2));
  EXPECT_EQ(result.quads.size(), 1u);
}

TEST(Cleanup, TriesNothingOnARegularGrid) {
  RegularitySummary summary;
  cleaned(grid_patch(7, 5), shapes::rectangle(7, 5, 7, 5), FunctionSize(1), &summary);
  EXPECT_EQ(summary.irregular_before, 0);
  EXPECT_EQ(summary.tried, 0);
}

TEST(Cleanup, FlatBoundaryVertexGetsItsSecondQuad) {
  QuadTopology topology(grid_patch(4, 4));
  int h = -1;
  topology.for_each_out(2, [&](int g) {
    if (topology.twin(g) >= 0) h = g;
  });
  ASSERT_TRUE(topology.can_rotate(h, false));
  topology.rotate(h, false);
  const QuadPatch mesh = topology.to_patch();
  ASSERT_EQ(topology.valence(2), 1);
  ASSERT_LT(worst_sine(mesh), 1e-12);
  const QuadPatch result = cleaned(mesh, shapes::rectangle(4, 4, 4, 4), FunctionSize(1));
  EXPECT_EQ(QuadTopology(result).valence(2), 2);
  EXPECT_GT(worst_sine(result), 0.9);
}

TEST(Cleanup, EdgeWithoutLengthIsOpened) {
  QuadPatch mesh = grid_patch(6, 6);
  mesh.points[mesh.n_boundary + 7] = mesh.points[mesh.n_boundary + 8] + Vec2{-1e-16, 0};
  const QuadPatch result = cleaned(mesh, FunctionSize(1));
  EXPECT_GT(worst_sine(result), 0.9);
}

TEST(Cleanup, RandomPolygonsWithHoles) {
  const FunctionSize size(0.06);
  for (int seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    const PatchBoundary boundary = shapes::random_polygon_with_holes(seed, 0.06);
    const auto placement = seed % 2 == 0 ? make_linf_delquad() : make_l2_frontal();
    const QuadPatch mesh = treat_paper(matched(boundary, size, FunctionCross(0.3), *placement), size);
    const QuadPatch result = cleaned(mesh, boundary, size);
    EXPECT_GT(worst_sine(result), 0);
    EXPECT_EQ(forced_bad(result), 0);
    expect_same(cleaned(mesh, size), result);
  }
}

TEST(Cleanup, WorksOnWhatMatchingLeaves) {
  const FunctionSize size(0.06);
  for (int seed = 0; seed < 5; ++seed) {
    SCOPED_TRACE(seed);
    const PatchBoundary boundary = shapes::random_polygon_with_holes(seed, 0.06);
    cleaned(matched(boundary, size), boundary, size);
  }
}

TEST(Cleanup, NoVerticesNearlyCoincide) {
  const FunctionSize size(0.15);
  for (int seed = 0; seed < 10; ++seed) {
    const PatchBoundary boundary = shapes::rotated(shapes::plate_with_holes(3, 20, 3, 0.3, 13), 0.1 * seed);
    const QuadPatch raw = matched(boundary, size, FunctionCross(0.1 * seed));
    EXPECT_GT(least_room(cleaned(raw, boundary, size), size), kShortSide) << seed;
    EXPECT_GT(least_room(cleaned(treat_paper(raw, size), boundary, size), size), kShortSide) << seed;
  }
}

}  // namespace
}  // namespace delquad
