// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/layout/field_lines.h"
#include "algorithms/layout/joint_layouts.h"
#include "algorithms/layout/layout.h"
#include "algorithms/layout/layout_arcs.h"
#include "tests/algorithms/stages.h"

namespace delquad {
namespace {

constexpr double kPrice = 3;  // of an irregular vertex

HarmonicCrossField field_of(const PatchBoundary& boundary) {
  return HarmonicCrossField(std::make_shared<const BackgroundMesh>(std::span(&boundary, 1)));
}

/// Lays a patch out, fills it and checks what must hold for any; how many irregular vertices there are, -1:
/// no layout.
int irregular_of(const PatchBoundary& boundary, double size) {
  const HarmonicCrossField cross = field_of(boundary);
  const FunctionSize delta(size);
  const auto lay_out = [&] {
    const auto layout = find_layout(boundary, cross, delta, LayoutEdges::kCounted);
    return layout ? fill_layout(*layout, boundary, cross, delta) : std::nullopt;
  };
  const auto mesh = lay_out();
  if (!mesh) return -1;
  expect_sound(*mesh, boundary);
  EXPECT_GT(worst_sine(*mesh), 0);
  EXPECT_TRUE(mesh->triangles.empty());
  const auto again = lay_out();
  EXPECT_TRUE(again && again->points == mesh->points && again->quads == mesh->quads);
  return count_irregular(*mesh);
}

TEST(FieldLines, GoStraightThroughASquare) {
  PatchBoundary boundary;
  shapes::add_polygon(boundary, {{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {4, 4, 4, 4});
  const LayoutVertices vertices{boundary.points, std::vector<double>(16, 1.0)};
  Rim rim;
  for (int i = 0; i < 16; ++i) rim.push_back({i, i % 4 == 0 ? 1 : 2});
  const FunctionCross cross(0);
  const FunctionSize size(1);
  FieldLines tracer(cross, size, vertices, {&rim, 1});
  std::vector<FieldLine> lines;
  tracer.trace({0, 4}, lines);
  EXPECT_TRUE(lines.empty()) << "a corner of one quad has no line";
  tracer.trace({0, 1}, lines);
  ASSERT_FALSE(lines.empty());
  const auto best = std::ranges::min_element(lines, {}, &FieldLine::misfit);
  EXPECT_EQ(best->to, (RimPlace{0, 11}));
  EXPECT_NEAR(best->edges.back(), 4, 1e-9);
  EXPECT_NEAR(best->misfit, 0, 1e-9);
  EXPECT_EQ(best->along, 1);
  EXPECT_EQ(best->back, 1);
  EXPECT_TRUE(tracer.is_free(best->from, best->to, std::vector<Vec2>{{1, 0}, {1, 4}}));
  EXPECT_FALSE(tracer.is_free(best->from, best->to, std::vector<Vec2>{{1, 0}, {5, 2}, {1, 4}}));
}

TEST(Layout, GridsNeedNoIrregularVertex) {
  PatchBoundary square;
  shapes::add_polygon(square, {{0, 0}, {3, 0}, {3, 2}, {0, 2}}, {12, 8, 12, 8});
  EXPECT_EQ(irregular_of(square, 0.25), 0);
  PatchBoundary angle;  // with a concave corner
  shapes::add_polygon(angle, {{0, 0}, {4, 0}, {4, 2}, {2, 2}, {2, 4}, {0, 4}}, {16, 8, 8, 8, 8, 16});
  EXPECT_EQ(irregular_of(angle, 0.25), 0);
}

TEST(Layout, AroundHolesOnlyWhatIsNecessary) {
  // At the corners of a square around it, five quads meet. With fewer edges than eight for each radius it
  // could not be so.
  EXPECT_EQ(irregular_of(shapes::plate_with_holes(4, 16, 1, 1, 28), 0.25), 4);
}

TEST(Layout, SoundWhateverTheOutline) {
  int laid = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const double size = 0.05;
    const PatchBoundary boundary = shapes::random_polygon_with_holes(seed, size);
    laid += irregular_of(boundary, size) >= 0 ? 1 : 0;
  }
  EXPECT_GE(laid, 8);
}

TEST(Layout, TakenOnlyWhereItIsMoreRegular) {
  const PatchBoundary boundary = shapes::plate_with_holes(4, 16, 1, 1, 28);
  const HarmonicCrossField cross = field_of(boundary);
  const FunctionSize size(0.25);
  const QuadPatch before = treat_paper(
      recombine(mesh_delquad(boundary, *make_linf_delquad(), cross, size), *make_primal_dual_solver()), size);
  ASSERT_GT(count_irregular(before), 4);
  LayoutSummary summary;
  const auto mesh = more_regular(before, boundary, cross, size, kPrice, &summary);
  ASSERT_TRUE(mesh);
  expect_sound(*mesh, boundary);
  EXPECT_EQ(count_irregular(*mesh), 4);
  EXPECT_EQ(summary.worse + summary.without, 0);
  EXPECT_FALSE(more_regular(*mesh, boundary, cross, size, kPrice, &summary)) << "none has fewer";
  EXPECT_EQ(summary.worse, 1);
  EXPECT_EQ(summary.irregular, 4);
}

TEST(LayoutArcs, KeepPiecesAndGetOtherNumbers) {
  const std::vector<int> runs{16, 16, 16, 16};
  const PatchBoundary boundary = shapes::plate_with_holes(4, 16, 1, 1, 28);
  const HarmonicCrossField cross = field_of(boundary);
  const FunctionSize size(0.25);
  const auto layout = find_layout(boundary, cross, size, LayoutEdges::kFree);
  ASSERT_TRUE(layout);
  std::vector<int> all = runs;
  all.push_back(28);
  const LayoutArcs arcs(*layout, boundary, all, size);
  std::vector<int> edges;
  for (const auto& arc : arcs.arcs()) edges.push_back(arc.edges());
  const PatchLayout same = arcs.with(edges, boundary, size);
  ASSERT_EQ(same.pieces.size(), layout->pieces.size());
  for (std::size_t i = 0; i < same.pieces.size(); ++i)
    EXPECT_EQ(same.pieces[i].size(), layout->pieces[i].size());
  ASSERT_EQ(arcs.of_runs().size(), all.size());
  for (std::size_t r = 0; r < all.size(); ++r) {
    int sum = 0;
    for (const int a : arcs.of_runs()[r]) sum += edges[a];
    EXPECT_EQ(sum, all[r]);
  }
  // Twice as many everywhere, on a boundary that has them.
  for (int& n : edges) n *= 2;
  const PatchBoundary finer = shapes::plate_with_holes(4, 32, 1, 1, 56);
  const PatchLayout other = arcs.with(edges, finer, size);
  for (std::size_t i = 0; i < other.pieces.size(); ++i)
    EXPECT_EQ(other.pieces[i].size(), 2 * layout->pieces[i].size());
  const auto mesh = fill_layout(other, finer, cross, FunctionSize(0.125));
  ASSERT_TRUE(mesh);
  expect_sound(*mesh, finer);
  EXPECT_EQ(count_irregular(*mesh), 4);
}

/// Rectangles side by side, as deep as wide, with other numbers of edges on the sides that they share.
struct RowOfBoxes {
  static constexpr double kDepth = 2;
  std::vector<int> uprights;
  FunctionCross cross{0};
  FunctionSize size{0.25};
  LayoutNetwork network;

  explicit RowOfBoxes(std::vector<int> given) : uprights(std::move(given)) {
    const int n = static_cast<int>(uprights.size()) - 1;
    // Uprights, then bottoms, then tops.
    for (const int edges : uprights) network.curves.push_back({edges, 1, true});
    for (int i = 0; i < 2 * n; ++i) network.curves.push_back({8, 1, true});
    network.curves.front().is_free = network.curves[n].is_free = false;
    network.boundary = [this](int p, const std::vector<int>& edges) { return std::optional(box(p, edges)); };
    network.is_allowed = [](const QuadPatch&, const PatchBoundary&) { return true; };
    for (int p = 0; p < n; ++p) {
      LayoutPatch& patch = network.patches.emplace_back();
      for (const int c : curves_of(p)) patch.runs.push_back({c, network.curves[c].edges});
      patch.boundary = box(p, numbers());
      patch.cross = &cross, patch.size = &size;
      patch.mesh = treat_paper(recombine(mesh_delquad(patch.boundary, *make_linf_delquad(), cross, size),
                                         *make_primal_dual_solver()),
                               size);
    }
  }
  std::array<int, 4> curves_of(int p) const {
    const int n = static_cast<int>(uprights.size()) - 1;
    return {n + 1 + p, p + 1, 2 * n + 1 + p, p};
  }
  std::vector<int> numbers() const {
    std::vector<int> all;
    for (const LayoutCurve& c : network.curves) all.push_back(c.edges);
    return all;
  }
  PatchBoundary box(int p, const std::vector<int>& edges) const {
    const double x = kDepth * p;
    const auto [bottom, right, top, left] = curves_of(p);
    PatchBoundary boundary;
    shapes::add_polygon(boundary, {{x, 0}, {x + kDepth, 0}, {x + kDepth, kDepth}, {x, kDepth}},
                        {edges[bottom], edges[right], edges[top], edges[left]});
    return boundary;
  }
  int irregular() const {
    int sum = 0;
    for (const LayoutPatch& patch : network.patches) sum += count_irregular(patch.mesh);
    return sum;
  }
};

TEST(LayoutsTogether, SharedCurvesGetTheNumbersWithWhichAllClose) {
  RowOfBoxes row({8, 6, 10, 8});
  ASSERT_GT(row.irregular(), 0);
  const JointLayoutSummary summary = lay_out_jointly(row.network, kPrice);
  EXPECT_EQ(row.numbers(), std::vector(10, 8));
  EXPECT_EQ(row.irregular(), 0);
  EXPECT_EQ(summary.accepted, 1);
  EXPECT_EQ(summary.patches, 3);
  EXPECT_EQ(summary.curves, 2);
  for (int p = 0; p < 3; ++p) {
    EXPECT_TRUE(row.network.patches[p].changed);
    expect_sound(row.network.patches[p].mesh, row.box(p, row.numbers()));
  }
  RowOfBoxes again({8, 6, 10, 8});
  lay_out_jointly(again.network, kPrice);
  for (int p = 0; p < 3; ++p)
    EXPECT_EQ(again.network.patches[p].mesh.points, row.network.patches[p].mesh.points);
}

TEST(LayoutsTogether, NothingChangesWhereNothingMayCost) {
  RowOfBoxes row({8, 4, 8});
  row.network.curves[1].is_free = false;
  const std::vector<int> before = row.numbers();
  const int irregular = row.irregular();
  lay_out_jointly(row.network, kPrice);
  EXPECT_EQ(row.numbers(), before) << "its curve was given";
  EXPECT_LE(row.irregular(), irregular);
  RowOfBoxes other({8, 6, 8});
  other.network.is_allowed = [](const QuadPatch&, const PatchBoundary&) { return false; };
  const std::vector<int> numbers = other.numbers();
  EXPECT_EQ(lay_out_jointly(other.network, kPrice).accepted, 0);
  EXPECT_EQ(other.numbers(), numbers);
  RowOfBoxes third({8, 6, 8});
  for (LayoutPatch& patch : third.network.patches) patch.cross = nullptr;
  EXPECT_EQ(lay_out_jointly(third.network, kPrice).filled, 0);
}

}  // namespace
}  // namespace delquad
