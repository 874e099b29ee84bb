#include "algorithms/layout/layout.h"

#include <gtest/gtest.h>

#include <memory>
#include <span>
#include <vector>

#include "algorithms/cleanup/cleanup.h"
#include "algorithms/insertion/frontal_mesher.h"
#include "algorithms/layout/field_lines.h"
#include "algorithms/recombination/recombine.h"
#include "algorithms/treatment/treatment.h"
#include "delquad/extend.h"
#include "fields/fields.h"
#include "tests/support/analytic_fields.h"
#include "tests/support/quad_patch_checks.h"
#include "tests/support/shapes.h"

namespace delquad {
namespace {

using namespace testing_support;

HarmonicCrossField field_of(const PatchBoundary& boundary) {
  return HarmonicCrossField(std::make_shared<const BackgroundMesh>(std::span(&boundary, 1)));
}

/// Lays a patch out and checks what must hold for any; how many irregular vertices there are, -1: no layout.
int irregular_of(const PatchBoundary& boundary, double size, const LayoutOptions& options = {},
                 LayoutSummary* summary = nullptr) {
  const HarmonicCrossField cross = field_of(boundary);
  const FunctionSize delta(size);
  LayoutSummary own;
  const auto mesh = lay_out(boundary, cross, delta, options, &own);
  EXPECT_EQ(own.patches, 1);
  EXPECT_EQ(own.without, mesh ? 0 : 1);
  if (summary != nullptr) *summary = own;
  if (!mesh) return -1;
  expect_sound(*mesh, boundary);
  EXPECT_GT(worst_sine(*mesh), 0);
  EXPECT_TRUE(mesh->triangles.empty());
  EXPECT_EQ(own.irregular, count_irregular(*mesh));
  const auto again = lay_out(boundary, cross, delta, options);
  EXPECT_TRUE(again && again->points == mesh->points && again->quads == mesh->quads);
  return own.irregular;
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
  LayoutSummary summary;
  EXPECT_EQ(irregular_of(angle, 0.25, {}, &summary), 0);
  EXPECT_GE(summary.cuts, 1);
  EXPECT_EQ(summary.mixed, 0);
}

TEST(Layout, AroundHolesOnlyWhatIsNecessary) {
  // At the corners of a square around it, five quads meet. With fewer edges than eight for each radius it
  // could not be so.
  EXPECT_EQ(irregular_of(shapes::plate_with_holes(4, 16, 1, 1, 28), 0.25), 4);
  const PatchBoundary four = shapes::plate_with_holes(8, 32, 2, 1, 28);
  const int irregular = irregular_of(four, 0.25);
  EXPECT_GE(irregular, 16);
  EXPECT_LE(irregular, 24);
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
  const auto mesh = more_regular(before, boundary, cross, size, {}, &summary);
  ASSERT_TRUE(mesh);
  expect_sound(*mesh, boundary);
  EXPECT_EQ(count_irregular(*mesh), 4);
  EXPECT_EQ(summary.worse + summary.without, 0);
  EXPECT_FALSE(more_regular(*mesh, boundary, cross, size, {}, &summary)) << "none has fewer";
  EXPECT_EQ(summary.worse, 1);
  EXPECT_EQ(summary.irregular, 4);
}

}  // namespace
}  // namespace delquad
