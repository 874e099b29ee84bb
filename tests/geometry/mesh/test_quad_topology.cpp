// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/relocation/quad_relocation.h"
#include "tests/support/meshing.h"
#include "tests/support/quad_patch_checks.h"
#include "tests/support/quad_patches.h"

namespace delquad {
namespace {

/// The half-edge from a to b; -1: none.
int half_edge(const QuadTopology& mesh, int a, int b) {
  int found = -1;
  mesh.for_each_out(a, [&](int h) {
    if (mesh.target(h) == b) found = h;
  });
  return found;
}

/// Quads as a set: each turned to start at its smallest vertex, sorted.
std::vector<std::array<int, 4>> canonical(std::vector<std::array<int, 4>> quads) {
  for (auto& q : quads) std::rotate(q.begin(), std::min_element(q.begin(), q.end()), q.end());
  std::sort(quads.begin(), quads.end());
  return quads;
}

void expect_same(const QuadPatch& a, const QuadPatch& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.quads, b.quads);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.n_boundary, b.n_boundary);
}

TEST(QuadTopology, GridAndBack) {
  const QuadPatch grid = grid_patch(4, 3);
  const QuadTopology mesh(grid);
  EXPECT_TRUE(check_invariants(mesh).empty());
  expect_same(mesh.to_patch(), grid);
  for (int v = 0; v < mesh.vertex_slots(); ++v) {
    const bool corner = v == 0 || v == 4 || v == 7 || v == 11;
    EXPECT_EQ(mesh.valence(v), corner ? 1 : mesh.on_boundary(v) ? 2 : 4);
    EXPECT_EQ(mesh.on_boundary(v), mesh.twin(mesh.out(v)) < 0);
  }
}

TEST(QuadTopology, RefusesWhatIsNoMesh) {
  QuadPatch mesh = grid_patch(2, 2);
  mesh.quads.push_back(mesh.quads[0]);
  EXPECT_THROW(QuadTopology{mesh}, std::invalid_argument);
  mesh = grid_patch(3, 3);
  mesh.quads.erase(mesh.quads.begin() + 4);  // a hole inside that is no boundary
  EXPECT_THROW(QuadTopology{mesh}, std::invalid_argument);
  mesh = grid_patch(2, 2);
  mesh.quads[1][2] = 99;
  EXPECT_THROW(QuadTopology{mesh}, std::invalid_argument);
  mesh.quads[1][2] = -1;
  EXPECT_THROW(QuadTopology{mesh}, std::invalid_argument);
}

TEST(QuadTopology, RotationTurnsBothWays) {
  const QuadPatch grid = grid_patch(3, 3);
  QuadTopology mesh(grid);
  const int a = 12, b = 13;  // two interior points
  const int h = half_edge(mesh, a, b);
  ASSERT_TRUE(mesh.can_rotate(h, true));
  const auto hexagon = mesh.hexagon(h);
  EXPECT_EQ(hexagon[0], b);
  EXPECT_EQ(hexagon[3], a);
  const int turned = mesh.rotate(h, true);
  EXPECT_EQ(mesh.valence(a), 3);
  EXPECT_EQ(mesh.valence(b), 3);
  EXPECT_EQ(std::minmax(mesh.origin(turned), mesh.target(turned)), std::minmax(hexagon[1], hexagon[4]));
  EXPECT_TRUE(check_invariants(mesh).empty());
  ASSERT_TRUE(mesh.can_rotate(turned, false));
  mesh.rotate(turned, false);
  EXPECT_EQ(canonical(mesh.to_patch().quads), canonical(grid.quads));
}

TEST(QuadTopology, OpeningGivesTheNextCornersAnEdgeAndTakesNone) {
  const QuadPatch grid = grid_patch(3, 3);
  for (const bool counterclockwise : {true, false}) {
    QuadTopology mesh(grid);
    const int h = half_edge(mesh, 12, 13);  // two interior points
    ASSERT_TRUE(mesh.can_open(h));
    const auto hexagon = mesh.hexagon(h);
    const auto start = mesh.mark();
    mesh.open(h, counterclockwise);
    EXPECT_TRUE(check_invariants(mesh).empty());
    const int first = mesh.vertex_slots() - 2;
    for (const int v : {first, first + 1}) EXPECT_EQ(mesh.valence(v), 3);
    const QuadTopology before(grid);
    for (int k = 0; k < 6; ++k)
      EXPECT_EQ(mesh.valence(hexagon[k]) - before.valence(hexagon[k]), k % 3 == (counterclockwise ? 1 : 2));
    const auto wrong = check_quad_patch(mesh.to_patch(), shapes::rectangle(3, 3, 3, 3), 1);
    EXPECT_TRUE(wrong.empty()) << wrong.front();
    for (int e = 0; e < mesh.element_slots(); ++e) EXPECT_GT(least_sine(mesh, e), 0.3);
    mesh.rollback(start);
    expect_same(mesh.to_patch(), grid);
  }
  const QuadTopology mesh(grid);
  EXPECT_FALSE(mesh.can_open(half_edge(mesh, 0, 1))) << "a side of the boundary";
}

TEST(QuadTopology, NoRotationOfBoundaryOrDoubletSides) {
  QuadTopology mesh(grid_patch(2, 1));
  EXPECT_FALSE(mesh.can_rotate(half_edge(mesh, 0, 1), true));
  // Two squares side by side: the middle side may turn to either diagonal of the rectangle.
  EXPECT_TRUE(mesh.can_rotate(half_edge(mesh, 1, 4), true));
  // A doublet's two quads share two sides; their union is no hexagon.
  QuadPatch doublet;
  doublet.points = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 1}};
  doublet.quads = {{0, 1, 2, 4}, {0, 4, 2, 3}};
  doublet.n_boundary = 4;
  QuadTopology two(doublet);
  EXPECT_FALSE(two.can_rotate(half_edge(two, 0, 4), true));
  EXPECT_FALSE(two.can_rotate(half_edge(two, 0, 4), false));
  ASSERT_TRUE(two.can_remove_doublet(4));
  two.remove_doublet(4);
  EXPECT_TRUE(check_invariants(two).empty());
  EXPECT_EQ(canonical(two.to_patch().quads), canonical({{0, 1, 2, 3}}));
}

TEST(QuadTopology, DoubletOfATriangleAndAQuad) {
  QuadPatch mesh;
  mesh.points = {{0, 0}, {2, 0}, {1, 2}, {1, 0.5}};
  mesh.quads = {{3, 1, 2, 0}};
  mesh.triangles = {{0, 1, 3}};
  mesh.n_boundary = 3;
  QuadTopology topology(mesh);
  ASSERT_TRUE(topology.can_remove_doublet(3));
  topology.remove_doublet(3);
  EXPECT_TRUE(check_invariants(topology).empty());
  EXPECT_EQ(topology.to_patch().triangles.size(), 1u);
  EXPECT_EQ(topology.to_patch().quads.size(), 0u);
}

TEST(QuadTopology, CollapseKeepsTheBoundaryPoint) {
  const QuadPatch grid = grid_patch(3, 3);
  QuadTopology mesh(grid);
  const int h = half_edge(mesh, 0, 1);  // the corner's quad; interior point 12 is opposite
  ASSERT_TRUE(mesh.can_collapse(h));
  mesh.collapse(h);
  EXPECT_TRUE(check_invariants(mesh).empty());
  EXPECT_FALSE(mesh.vertex_alive(12));
  EXPECT_EQ(mesh.valence(0), 1 + 4 - 2);
  EXPECT_EQ(mesh.valence(1), 1);
  const auto wrong = check_quad_patch(mesh.to_patch(), shapes::rectangle(3, 3, 3, 3), 1);
  EXPECT_TRUE(wrong.empty()) << wrong.front();
  EXPECT_FALSE(mesh.can_collapse(half_edge(mesh, 15, 5))) << "the opposite corner is on the boundary";
}

TEST(QuadTopology, NoCollapseIntoADoubleEdge) {
  QuadPatch patch;
  patch.points = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {2, 2}, {1.5, 1}, {2, 0.6}};
  patch.quads = {{0, 1, 6, 5}, {1, 4, 5, 6}, {0, 5, 4, 3}, {1, 2, 3, 4}};
  patch.n_boundary = 4;
  const QuadTopology mesh(patch);
  // 0 and 4 are opposite corners of a quad, but both have an edge to 1, which is no corner of it.
  ASSERT_EQ(mesh.valence(5), 3);
  ASSERT_TRUE(mesh.adjacent(0, 1) && mesh.adjacent(4, 1));
  EXPECT_FALSE(mesh.can_collapse(half_edge(mesh, 0, 5)));
}

TEST(QuadTopology, PillowMakesFiveOfOne) {
  QuadTopology mesh(grid_patch(1, 1));
  mesh.pillow(std::array<int, 1>{0});
  EXPECT_TRUE(check_invariants(mesh).empty());
  EXPECT_EQ(mesh.to_patch().quads.size(), 5u);
  for (int v = 0; v < 4; ++v) EXPECT_EQ(mesh.valence(v), 2);
  for (int v = 4; v < 8; ++v) EXPECT_EQ(mesh.valence(v), 3);
}

TEST(QuadTopology, PillowAroundSeveralQuads) {
  const QuadPatch grid = grid_patch(4, 3);
  const std::vector<std::vector<int>> sets = {{0, 1, 4, 5}, {5, 6}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}};
  for (const auto& quads : sets) {
    QuadTopology mesh(grid);
    ASSERT_TRUE(mesh.can_pillow(quads));
    const auto start = mesh.mark();
    mesh.pillow(quads);
    EXPECT_TRUE(check_invariants(mesh).empty());
    const auto wrong = check_quad_patch(mesh.to_patch(), shapes::rectangle(4, 3, 4, 3), 1);
    EXPECT_TRUE(wrong.empty()) << wrong.front();
    mesh.rollback(start);
    expect_same(mesh.to_patch(), grid);
  }
  QuadTopology mesh(grid);
  mesh.pillow(sets[0]);
  EXPECT_EQ(mesh.to_patch().quads.size(), 12u + 8u);
  EXPECT_EQ(mesh.valence(0), 2);
  EXPECT_EQ(mesh.valence(1), 2) << "two quads inside went, two of the ring came";
  EXPECT_FALSE(QuadTopology(grid).can_pillow(std::vector<int>{0, 5})) << "they touch at a vertex";
  QuadPatch triangle;
  triangle.points = {{0, 0}, {1, 0}, {0, 1}};
  triangle.triangles = {{0, 1, 2}};
  triangle.n_boundary = 3;
  EXPECT_FALSE(QuadTopology(triangle).can_pillow(std::vector<int>{0}));
}

TEST(QuadTopology, RefillAndBack) {
  const QuadPatch grid = grid_patch(4, 3);
  const PatchBoundary boundary = shapes::rectangle(4, 3, 4, 3);
  QuadTopology mesh(grid);
  // The two by two quads in the lower left corner; counterclockwise from there. One quad, then two by two
  // again.
  const int inside = grid.n_boundary, east = inside + 1, north = inside + 3, far = inside + 4;
  const std::array<int, 4> quads{0, 1, 4, 5};
  const std::array<int, 8> loop{0, 1, 2, east, far, north, 12, 13};
  std::array<int, 8> rim;
  for (int i = 0; i < 8; ++i) rim[i] = half_edge(mesh, loop[i], loop[(i + 1) % 8]);
  ASSERT_TRUE(std::ranges::none_of(rim, [](int h) { return h < 0; }));
  const std::vector<std::array<int, 4>> same = {{0, 1, 8, 7}, {1, 2, 3, 8}, {8, 3, 4, 5}, {7, 8, 5, 6}};
  const auto start = mesh.mark();
  ASSERT_TRUE(mesh.refill(quads, rim, std::array{Vec2{1, 1}}, same));
  EXPECT_TRUE(check_invariants(mesh).empty());
  EXPECT_FALSE(mesh.vertex_alive(inside));
  const auto wrong = check_quad_patch(mesh.to_patch(), boundary, 1);
  EXPECT_TRUE(wrong.empty()) << wrong.front();
  for (int v = inside + 1; v < mesh.vertex_slots(); ++v) EXPECT_EQ(mesh.valence(v), 4);
  mesh.rollback(start);
  expect_same(mesh.to_patch(), grid);
  EXPECT_TRUE(check_invariants(mesh).empty());
}

TEST(QuadTopology, NoRefillWithADoubleEdge) {
  QuadPatch patch;
  patch.points = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {2, 2}, {1.5, 1}, {2, 0.6}};
  patch.quads = {{0, 1, 6, 5}, {1, 4, 5, 6}, {0, 5, 4, 3}, {1, 2, 3, 4}};
  patch.n_boundary = 4;
  QuadTopology mesh(patch);
  const std::array<int, 6> loop{5, 6, 1, 4, 3, 0};
  std::array<int, 6> rim;
  for (int i = 0; i < 6; ++i) rim[i] = half_edge(mesh, loop[i], loop[(i + 1) % 6]);
  // An edge from 0 to 1, beside the one on the boundary.
  const std::vector<std::array<int, 4>> fill = {{5, 0, 1, 2}, {2, 3, 4, 5}};
  EXPECT_FALSE(mesh.refill(std::array{1, 2}, rim, {}, fill));
  expect_same(mesh.to_patch(), patch);
}

TEST(QuadTopology, SplitIsTheInverseOfCollapse) {
  const QuadPatch grid = grid_patch(4, 4);
  QuadTopology mesh(grid);
  const int v = 20;  // the middle of the grid: neighbors 21 (right), 23 (above), 19 (left), 17 (below)
  const int right = half_edge(mesh, v, 21), left = half_edge(mesh, v, 19);
  ASSERT_TRUE(mesh.can_split(right, left));
  const auto start = mesh.mark();
  mesh.split(right, left);
  EXPECT_TRUE(check_invariants(mesh).empty());
  const int opened = mesh.vertex_slots() - 1, quad = mesh.element_slots() - 1;
  EXPECT_TRUE(mesh.adjacent(opened, 23) && !mesh.adjacent(v, 23)) << "what lies left of the first edge goes";
  EXPECT_TRUE(mesh.adjacent(v, 17) && !mesh.adjacent(opened, 17));
  for (const int w : {v, opened}) EXPECT_EQ(mesh.valence(w), 3);
  for (const int w : {19, 21}) EXPECT_EQ(mesh.valence(w), 5);
  const auto wrong = check_quad_patch(mesh.to_patch(), shapes::rectangle(4, 4, 4, 4), 1);
  EXPECT_TRUE(wrong.empty()) << wrong.front();
  QuadTopology again(mesh.to_patch());
  again.collapse(4 * quad);
  EXPECT_EQ(canonical(again.to_patch().quads), canonical(grid.quads));
  mesh.rollback(start);
  expect_same(mesh.to_patch(), grid);
}

TEST(QuadTopology, NoSplitIntoADoubletOrAcrossTheOutside) {
  const QuadTopology mesh(grid_patch(4, 4));
  EXPECT_FALSE(mesh.can_split(half_edge(mesh, 20, 21), half_edge(mesh, 20, 21)));
  EXPECT_FALSE(mesh.can_split(half_edge(mesh, 20, 21), half_edge(mesh, 20, 23))) << "one element between";
  EXPECT_FALSE(mesh.can_split(half_edge(mesh, 20, 21), half_edge(mesh, 20, 17))) << "one element left";
  EXPECT_FALSE(mesh.can_split(half_edge(mesh, 20, 21), half_edge(mesh, 19, 20))) << "other vertices";
  const int inwards = mesh.around(mesh.out(2));
  EXPECT_FALSE(mesh.can_split(mesh.out(2), inwards)) << "a side of the boundary";
  EXPECT_FALSE(mesh.can_split(inwards, mesh.out(2)));
}

TEST(QuadTopology, RandomEditsKeepAllInvariantsAndAreRevocable) {
  const PatchBoundary boundary = shapes::rectangle(6, 5, 6, 5);
  std::mt19937_64 random(7);
  QuadTopology mesh(grid_patch(6, 5));
  int rotations = 0, openings = 0, collapses = 0, doublets = 0, insets = 0, splits = 0, rollbacks = 0;
  QuadPatch kept = mesh.to_patch();
  auto mark = mesh.mark();
  for (int step = 0; step < 8000; ++step) {
    const int h = static_cast<int>(random() % (4 * mesh.element_slots()));
    const int v = static_cast<int>(random() % mesh.vertex_slots());
    const auto kind = random() % 18;
    if (kind < 9 && mesh.can_rotate(h, kind % 2 == 0)) {
      mesh.rotate(h, kind % 2 == 0);
      ++rotations;
    } else if (kind < 11 && mesh.can_collapse(h)) {
      mesh.collapse(h);
      ++collapses;
    } else if (kind == 13 && mesh.is_quad(QuadTopology::element(h)) && mesh.to_patch().quads.size() < 60) {
      mesh.pillow(std::array<int, 1>{QuadTopology::element(h)});
      ++insets;
    } else if ((kind == 11 || kind == 12) && mesh.vertex_alive(v) && mesh.to_patch().quads.size() < 60) {
      std::vector<int> spokes;
      mesh.for_each_out(v, [&](int g) { spokes.push_back(g); });
      const int from = spokes[random() % spokes.size()], to = spokes[random() % spokes.size()];
      if (!mesh.can_split(from, to)) continue;
      mesh.split(from, to);
      ++splits;
    } else if (kind >= 16 && mesh.can_open(h) && mesh.to_patch().quads.size() < 50) {
      mesh.open(h, step % 2 == 0);
      ++openings;
    } else if (kind >= 14 && kind < 16 && mesh.can_remove_doublet(v)) {
      mesh.remove_doublet(v);
      ++doublets;
    } else {
      continue;
    }
    if (mesh.vertex_alive(v) && !mesh.on_boundary(v)) mesh.move(v, {double(step), 0});
    ASSERT_TRUE(check_invariants(mesh).empty()) << step << ": " << check_invariants(mesh).front();
    const auto wrong = check_quad_patch(mesh.to_patch(), boundary, 1);
    ASSERT_TRUE(wrong.empty()) << step << ": " << wrong.front();
    if (random() % 4 == 0) {
      mesh.rollback(mark);
      ++rollbacks;
      expect_same(mesh.to_patch(), kept);
      ASSERT_TRUE(check_invariants(mesh).empty());
    } else if (random() % 4 == 0) {
      mesh.commit();
      mark = mesh.mark();
      kept = mesh.to_patch();
    }
  }
  EXPECT_GT(std::min({rotations, openings, collapses, doublets, insets, splits, rollbacks}), 20);
}

}  // namespace
}  // namespace delquad
