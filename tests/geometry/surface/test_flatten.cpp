// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/flatten.h"
#include "geometry/surface/improve_triangulation.h"
#include "tests/support/flat_patch_checks.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

/// Largest relative change of a side's length.
double length_error(const SurfaceModel& model, const FlatPatch& p) {
  double worst = 0;
  for (const auto& v : p.flat.triangles)
    for (int k = 0; k < 3; ++k) {
      const int a = v[k], b = v[(k + 1) % 3];
      const double l = norm(model.fine.points[p.fine_node[a]] - model.fine.points[p.fine_node[b]]);
      worst = std::max(worst, std::abs(norm(p.flat.points[a] - p.flat.points[b]) / l - 1));
    }
  return worst;
}

Flattening flatten_to_one_patch(SurfaceModel& model) {
  Flattening f = flatten(model);
  expect_sound_flattening(model, f);
  EXPECT_EQ(f.patches.size(), 1u);
  return f;
}

TEST(Flatten, CylinderUnrollsExactly) {
  SurfaceModel model = cylinder(40, 12, 1, 4);
  const Flattening f = flatten_to_one_patch(model);
  ASSERT_EQ(f.cuts.size(), 1u);
  EXPECT_FALSE(f.cuts[0].divides);
  EXPECT_NEAR(f.cuts[0].length, 4, 1e-9);
  EXPECT_LT(length_error(model, f.patches[0]), 1e-9);
  EXPECT_EQ(f.patches[0].method, "boundary-first");
}

TEST(Flatten, ConesUnrollExactly) {
  for (double half_angle : {0.1, 0.5, 1.0, 1.3}) {
    SurfaceModel model = cone(36, 18, half_angle);
    const Flattening f = flatten(model);
    expect_sound_flattening(model, f);
    if (f.cuts.empty()) {
      ASSERT_EQ(f.patches.size(), 1u) << half_angle;
      EXPECT_LE(f.patches[0].quality.area_ratio, 2) << half_angle;
      continue;
    }
    // The cut to a blunt tip goes on behind it: else the patch would meet itself there.
    const std::size_t halves = 2 * std::numbers::pi * std::sin(half_angle) > 3.5 ? 2 : 1;
    ASSERT_EQ(f.patches.size(), halves) << half_angle;
    ASSERT_EQ(f.cuts.size(), halves) << half_angle;
    for (const FlatPatch& patch : f.patches) {
      EXPECT_LT(length_error(model, patch), 1e-8) << half_angle;
      EXPECT_LT(patch.quality.extreme_ratio, 1.001) << half_angle;
    }
  }
}

TEST(Flatten, PlaneWithHolesStaysWhole) {
  // A ring in a tilted plane.
  SurfaceModel model = grid_surface({30, 3, true}, [](double u, double v) {
    const double phi = 2 * std::numbers::pi * u, r = 2 - v;
    return Vec3{r * std::cos(phi), r * std::sin(phi), 0.3 * r * std::cos(phi) + 7};
  });
  const Flattening f = flatten_to_one_patch(model);
  EXPECT_TRUE(f.cuts.empty());
  EXPECT_EQ(f.patches[0].method, "plane");
  EXPECT_LT(length_error(model, f.patches[0]), 1e-12);
}

TEST(Flatten, TorusOpensToOnePatch) {
  SurfaceModel model = torus(60, 24, 3, 1);
  const Flattening f = flatten_to_one_patch(model);
  EXPECT_EQ(f.cuts.size(), 2u);
  // The scale of the conformal map goes with the distance from the axis, from 2 to 4: with its square, the
  // area.
  EXPECT_NEAR(f.patches[0].quality.area_ratio, 4, 0.3);
}

// Every shape, with what it must not exceed.
TEST(Flatten, AllShapes) {
  struct Case {
    const char* name;
    SurfaceModel model;
    std::size_t max_patches;
  };
  Case cases[] = {
      {"bump", bump(30, 0.8), 1},
      {"steep bump", bump(50, 2.5), 14},
      {"long tube", cylinder(16, 60, 1, 40), 1},
      {"needle cone", cone(12, 10, 0.05), 1},
      {"cap", sphere_cap(30, 15, 1), 1},
      {"nearly a sphere", sphere_cap(60, 40, 2.97), 3},
      {"sphere", round_sphere(8), 2},
      {"tee", tee(4), 4},
      {"two handles", double_torus(4), 9},
      {"cube", CubeSurface({{0, 0, 0}}, {}, 1).rounded(0), 6},
      {"angular tee",
       CubeSurface({{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, {{-2, 0, 0}, {2, 0, 0}, {0, 0, 2}}, 3)
           .rounded(0),
       6}};
  for (Case& c : cases) {
    SCOPED_TRACE(c.name);
    improve_triangulation(c.model);
    const Flattening f = flatten(c.model);
    expect_sound_flattening(c.model, f);
    EXPECT_LE(f.patches.size(), c.max_patches);
    EXPECT_EQ(c.model.fine.curves.size() >= f.cuts.size(), true);
    for (const FlatPatch& p : f.patches) EXPECT_LE(p.quality.area_ratio, 10);
  }
}

// The cut of one face ends inside a curve that another face shares: both agree on the new corner.
TEST(Flatten, NeighboursOfACutStayConforming) {
  // A closed cylinder: wall, top and bottom.
  SurfaceModel model = cylinder(24, 6, 1, 3);
  Mesh& fine = model.fine;
  for (int curve : {0, 1}) {
    const int centre = static_cast<int>(fine.points.size());
    double z = 0;
    for (std::size_t l = 0; l < fine.lines.size(); ++l) {
      if (fine.line_curve[l] != curve) continue;
      fine.triangles.push_back({fine.lines[l][1], fine.lines[l][0], centre});
      fine.triangle_region.push_back(1 + curve);
      z = fine.points[fine.lines[l][0]].z;
    }
    fine.points.push_back({0, 0, z});
    fine.regions.push_back({2 + curve, {}});
  }
  ASSERT_TRUE(check_invariants(fine).empty());
  improve_triangulation(model);
  const Flattening f = flatten(model);
  expect_sound_flattening(model, f);
  ASSERT_EQ(f.patches.size(), 3u);
  EXPECT_EQ(f.cuts.size(), 1u);
  EXPECT_EQ(f.patches[1].method, "plane");
  EXPECT_EQ(f.patches[2].method, "plane");
  EXPECT_EQ(model.corners.size(), 2u);
}

// Two faces are cut open at a closed curve that they share: it is not parted at a short piece.
TEST(Flatten, CutsOfNeighboursMeet) {
  // A drilled hole: its tip, of 118 degrees, above z = 0, and its wall.
  const double height = 1 / std::tan(59 * std::numbers::pi / 180);
  SurfaceModel model = grid_surface({36, 30, true, false, true}, [&](double u, double v) {
    const double phi = 2 * std::numbers::pi * u, r = std::min(1.0, 5 * v);
    return Vec3{r * std::cos(phi), r * std::sin(phi), v < 0.2 ? (1 - r) * height : 10 * (0.2 - v)};
  });
  Mesh& fine = model.fine;
  const auto is_wall = [&](int p) { return fine.points[p].z < 1e-9; };
  std::map<int, int> next;  // on the curve between both
  for (std::size_t t = 0; t < fine.triangles.size(); ++t) {
    const auto& v = fine.triangles[t];
    fine.triangle_region[t] = std::ranges::all_of(v, is_wall) ? 1 : 0;
    for (int k = 0; k < 3; ++k)
      if (fine.triangle_region[t] == 0 && is_wall(v[k]) && is_wall(v[(k + 1) % 3]))
        next[v[k]] = v[(k + 1) % 3];
  }
  ASSERT_EQ(next.size(), 36u);
  fine.regions.push_back({2, {}});
  fine.curves.push_back({2, {}});
  // It begins beside where the cut of the wall comes to from the other end.
  int p = fine.lines[0][0];
  p = std::ranges::min_element(next, {}, [&](const auto& line) {
        const Vec3 d = fine.points[line.first] - fine.points[p];
        return std::hypot(d.x, d.y);
      })->first;
  for (int turned = 0; turned < 2; ++turned) p = next[p];
  for (std::size_t i = 0; i < next.size(); ++i, p = next[p]) {
    fine.lines.push_back({p, next[p]});
    fine.line_curve.push_back(1);
  }
  ASSERT_TRUE(check_invariants(fine).empty());
  improve_triangulation(model);
  const Flattening f = flatten(model);
  expect_sound_flattening(model, f);
  ASSERT_EQ(f.patches.size(), 3u);
  int corners = 0;
  for (const int c : model.corners) corners += std::abs(fine.points[c].z) < 1e-9 ? 1 : 0;
  EXPECT_EQ(corners, 2);  // of the cut through the tip, and one of them is the tube's
}

TEST(Flatten, SameInputSameOutput) {
  auto run = [] {
    SurfaceModel model = double_torus(3);
    improve_triangulation(model);
    return std::pair(flatten(model), model.fine.points);
  };
  const auto [a, points_a] = run();
  const auto [b, points_b] = run();
  EXPECT_EQ(points_a, points_b);
  ASSERT_EQ(a.patches.size(), b.patches.size());
  for (std::size_t i = 0; i < a.patches.size(); ++i)
    EXPECT_EQ(a.patches[i].flat.points, b.patches[i].flat.points);
}

TEST(Flatten, NamesFacesThatCannotBe) {
  // A face of zero area.
  SurfaceModel model = one_face({{3, 1, 1}, {4, 1, 1}, {5, 1, 1}}, {{0, 1, 2}});
  const Flattening f = flatten(model);
  EXPECT_TRUE(f.patches.empty());
  EXPECT_EQ(f.failed, std::vector<int>{0});
  EXPECT_EQ(f.failed_at.at(0).low, (Vec3{3, 1, 1}));
  EXPECT_EQ(f.failed_at.at(0).high, (Vec3{5, 1, 1}));
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_EQ(model.warnings[0].text, "face 1: could not be flattened [not-flattened]");
}

}  // namespace
}  // namespace delquad
