// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/segment.h"
#include "geometry/surface/ignore_small.h"
#include "tests/support/meshing.h"
#include "tests/support/surface_model_checks.h"

namespace delquad {
namespace {

constexpr double kWide = 0.05;

/// Rows of cells between x[i] and x[i + 1], row j from height(j, x) to height(j + 1, x); region_of(i, j)
/// from 1.
SurfaceModel sheet(const std::vector<double>& x, int rows, int n_regions,
                   const std::function<double(int, double)>& height,
                   const std::function<int(int, int)>& region_of) {
  TriangulatedShape shape;
  const auto at = [&](int i, int j) { return Vec3{x[i], height(j, x[i]), 0}; };
  for (int region = 1; region <= n_regions; ++region) {
    shape.region();
    for (int i = 0; i + 1 < static_cast<int>(x.size()); ++i)
      for (int j = 0; j < rows; ++j) {
        if (region_of(i, j) != region) continue;
        // Cells may end in a point on the left.
        if (height(j, x[i]) < height(j + 1, x[i])) shape.triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1));
        shape.triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      }
  }
  return make_surface_model(std::move(shape.mesh), {.feature_angle = 30});
}

std::vector<double> steps(double from, double to, int n) {
  std::vector<double> x;
  for (int i = 0; i <= n; ++i) x.push_back(from + (to - from) * i / n);
  return x;
}

/// The square [0, 1] x [-1, 1]: below y = 0 region 1, above y = slope x region 2, region 3 the wedge between.
SurfaceModel wedge(double slope) {
  return sheet(
      steps(0, 1, 8), 3, 3,
      [=](int j, double x) {
        return j == 0 ? -1 : j == 1 ? 0 : j == 2 ? slope * x : 1;
      },
      [](int, int j) { return j == 0   ? 1
                              : j == 1 ? 3
                                       : 2; });
}

/// Two squares, [0, 1] x [0, 1] and [2, 3] x [0, 1], and between them a neck 0.02 wide. The neck is region 1,
/// in a sheet of regions 2 and 3 below and above it, or of none.
SurfaceModel dumbbell(bool has_sheet) {
  constexpr double kHeights[] = {0, 0.49, 0.51, 1};
  return sheet(
      steps(0, 3, 12), 3, has_sheet ? 3 : 1, [&](int j, double) { return kHeights[j]; },
      [=](int i, int j) {
        if (i < 4 || i >= 8 || j == 1) return 1;
        return has_sheet ? j == 0 ? 2 : 3 : 0;
      });
}

double area(const SurfaceModel& model, int tag) {
  double sum = 0;
  const Mesh& mesh = model.fine;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    if (mesh.regions[mesh.triangle_region[t]].tag == tag)
      sum += norm(cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a])) / 2;
  }
  return sum;
}

int count_texts(const SurfaceModel& model, const std::string& part) {
  const auto all = texts(model.warnings);
  return static_cast<int>(
      std::ranges::count_if(all, [&](const std::string& s) { return s.find(part) != s.npos; }));
}

TEST(NarrowParts, ATipGoesWhereItIsNarrow) {
  constexpr double kSlope = 0.2;
  const SurfaceModel model = wedge(kSlope);
  for (const double length : {kWide, kWide / 2}) {
    const SurfaceModel blunt = ignore_small(model, {length});
    expect_counts(blunt, 3, 11, 9);
    // What is left ends in an edge that is as long as the part may be wide, and hardly longer.
    EXPECT_LE(area(blunt, 3), kSlope / 2 - length * length / kSlope / 2);
    EXPECT_NEAR(area(blunt, 3), kSlope / 2 - length * length / kSlope / 2, 0.12 * length * length / kSlope);
    EXPECT_NEAR(area(blunt, 1) + area(blunt, 2) + area(blunt, 3), 2, 1e-12);
    EXPECT_EQ(count_texts(blunt, "a part of face 3, "), 1);
  }
}

TEST(NarrowParts, SharpAnglesThatWidenSoonStay) {
  const SurfaceModel model = wedge(0.7);
  EXPECT_EQ(ignore_small(model, {kWide}).fine.triangles, model.fine.triangles);
}

TEST(NarrowParts, BothSidesOfANeckStay) {
  const SurfaceModel model = dumbbell(true);
  const SurfaceModel apart = ignore_small(model, {kWide});
  EXPECT_EQ(violations(apart), std::vector<std::string>{});
  ASSERT_EQ(apart.fine.regions.size(), 4u) << "a face is in one piece";
  EXPECT_EQ(apart.fine.regions[0].tag, 1);
  EXPECT_EQ(apart.fine.regions[3].tag, 4);
  // The ends of the neck are short curves, which become points: half of its width may go to either side.
  EXPECT_NEAR(area(apart, 1), 1, 0.01);
  EXPECT_NEAR(area(apart, 4), 1, 0.01);
  EXPECT_NEAR(area(apart, 2) + area(apart, 3), 1, 0.02);
}

TEST(NarrowParts, ANeckOfFreeEdgesStays) {
  const SurfaceModel model = dumbbell(false);
  const SurfaceModel same = ignore_small(model, {kWide});
  expect_counts(same, 1, model.fine.curves.size(), model.corners.size());
  EXPECT_NEAR(area(same, 1), 2.02, 1e-12);
}

TEST(NarrowParts, WhatHasANameStaysWhereThatIsAskedFor) {
  SurfaceModel model = wedge(0.2);
  model.fine.regions[2].names = {"wedge"};
  EXPECT_EQ(ignore_small(model, {kWide, {true}}).fine.triangles, model.fine.triangles);
  const SurfaceModel blunt = ignore_small(model, {kWide});
  EXPECT_EQ(count_texts(blunt, "face 3 (wedge)"), 1);
  EXPECT_EQ(count_texts(blunt, "has the name"), 0) << "there is a face of that name";
  for (Entity& face : model.fine.regions) face.names = {"wedge"};
  EXPECT_EQ(ignore_small(model, {kWide, {true}}).fine.triangles, blunt.fine.triangles) << "no name goes";
}

TEST(NarrowParts, NamesThatGoAreTold) {
  SurfaceModel model = wedge(0.2);
  model.fine.regions[2].names = {"wedge"};
  for (Entity& curve : model.fine.curves) curve.names = {"curve " + std::to_string(curve.tag)};
  const SurfaceModel none = ignore_small(model, {0.3});
  EXPECT_EQ(none.fine.regions.size(), 2u);
  EXPECT_EQ(count_texts(none, "no face has the name 'wedge' any more"), 1);
  EXPECT_GE(count_texts(none, "no curve has the name 'curve "), 1);
  const SurfaceModel all = ignore_small(model, {0.3, {true}});
  EXPECT_EQ(all.fine.triangles, model.fine.triangles);
  EXPECT_EQ(count_texts(all, "any more"), 0);
}

/// The plane z = 0, which knows how many faces and curves it has.
class Plane final : public SurfaceProjector {
 public:
  Plane(std::size_t faces, std::size_t curves)
      : faces_(static_cast<int>(faces)), curves_(static_cast<int>(curves)) {}
  Vec3 to_face(int face, const Vec3& x) const override {
    EXPECT_TRUE(face >= 0 && face < faces_);
    return {x.x, x.y, 0};
  }
  Vec3 to_curve(int curve, const Vec3& x) const override {
    EXPECT_TRUE(curve >= 0 && curve < curves_);
    return {x.x, x.y, 0};
  }

 private:
  int faces_, curves_;
};

TEST(NarrowParts, EveryFaceAndCurveIsOnesOfTheModel) {
  SurfaceModel model = dumbbell(true);
  model.projector = std::make_shared<Plane>(model.fine.regions.size(), model.fine.curves.size());
  for (const double length : {kWide, 0.01}) {
    const SurfaceModel after = ignore_small(model, {length});
    for (int face = 0; face < static_cast<int>(after.fine.regions.size()); ++face)
      EXPECT_EQ(after.projector->to_face(face, {1.5, 0.5, 1}), (Vec3{1.5, 0.5, 0}));
    for (int curve = 0; curve < static_cast<int>(after.fine.curves.size()); ++curve)
      EXPECT_EQ(after.projector->to_curve(curve, {1.5, 0.5, 1}), (Vec3{1.5, 0.5, 0}));
  }
}

TEST(IgnoreSmall, NoPointMovesFartherThanTheLength) {
  // A face of eight sides, each shorter than the length, inside of another one.
  TriangulatedShape shape;
  const auto at = [](int i, double radius) {
    const double angle = i % 8 * std::numbers::pi / 4;
    return Vec3{radius * std::cos(angle), radius * std::sin(angle), 0};
  };
  constexpr double kRadius = 0.06;  // sides of 0.046
  shape.region();
  for (int i = 0; i < 8; ++i) shape.triangle({0, 0, 0}, at(i, kRadius), at(i + 1, kRadius));
  shape.region();
  for (int i = 0; i < 8; ++i) {
    shape.triangle(at(i, kRadius), at(i, 1), at(i + 1, 1));
    shape.triangle(at(i, kRadius), at(i + 1, 1), at(i + 1, kRadius));
  }
  const SurfaceModel model = make_surface_model(std::move(shape.mesh), {.feature_angle = 30});
  const SurfaceModel after = ignore_small(model, {kWide});
  EXPECT_EQ(violations(after), std::vector<std::string>{});
  EXPECT_LT(after.fine.curves.size(), model.fine.curves.size());
  for (const auto& line : model.fine.lines) {
    const Vec3& p = model.fine.points[line[0]];
    double nearest = 1;
    for (const auto& [a, b] : after.fine.lines)
      nearest = std::min(nearest, distance_to_segment(p, after.fine.points[a], after.fine.points[b]));
    EXPECT_LE(nearest, kWide);
  }
}

}  // namespace
}  // namespace delquad
