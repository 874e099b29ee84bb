// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>

#include "features/symmetry/symmetry_planes.h"
#include "geometry/surface/triangulated_model.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/grid_mesh.h"
#include "tests/support/surface_model_checks.h"
#include "tests/support/triangulated_shapes.h"

namespace delquad {
namespace {

using testing_support::box;
using testing_support::triangle_grid;
using testing_support::violations;
using testing_support::volume;

const std::vector<std::string> kSoundMirror;
constexpr MirrorPlane kLeftSide = {{0, 0, 0}, {2, 0, 0}, 1e-9};

/// The faces of a box of unit volume but for the one at x = 0.
Mesh open_box() {
  Mesh mesh = box(1);
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& v = mesh.triangles[t];
    if (std::all_of(v.begin(), v.end(), [&](int p) { return mesh.points[p].x == 0; })) continue;
    mesh.triangles[kept] = mesh.triangles[t];
    mesh.triangle_region[kept++] = mesh.triangle_region[t];
  }
  mesh.triangles.resize(kept);
  mesh.triangle_region.resize(kept);
  return mesh;
}

TEST(Mirror, AnOpenBoxBecomesAClosedOneOfTwiceTheVolume) {
  const Mesh half = open_box();
  const SurfaceModel model = make_surface_model(add_mirror_image(half, kLeftSide, "box"));
  EXPECT_EQ(violations(model), kSoundMirror);
  EXPECT_TRUE(model.warnings.empty());
  EXPECT_NEAR(volume(model.fine), 2, 1e-12);
  // Sides run on through the plane, the two ends are faces of their own.
  EXPECT_EQ(model.fine.regions.size(), 6u);
  EXPECT_EQ(model.fine.curves.size(), 12u);
}

TEST(Mirror, FacesMayEndAtThePlane) {
  MirrorPlane plane = kLeftSide;
  plane.join = false;
  const SurfaceModel model = make_surface_model(add_mirror_image(open_box(), plane, "box"));
  EXPECT_EQ(violations(model), kSoundMirror);
  EXPECT_NEAR(volume(model.fine), 2, 1e-12);
  EXPECT_EQ(model.fine.regions.size(), 10u);
  EXPECT_EQ(model.fine.curves.size(), 20u);
}

TEST(Mirror, RaggedCutsAreStraightened) {
  Mesh half = triangle_grid(8, 8, 1, 1);
  half.lines.clear();
  half.line_curve.clear();
  constexpr double kRagged = 1e-4;
  for (Vec3& p : half.points)
    if (p.x == 0) p.x = (p.y < 0.5 ? 1 : -1) * kRagged;
  expect_input_error([&] { add_mirror_image(half, kLeftSide, "grid.msh"); }, {"grid.msh", "both sides"});
  MirrorPlane plane = kLeftSide;
  plane.tolerance = 2 * kRagged;
  const Mesh whole = add_mirror_image(half, plane, "grid.msh");
  EXPECT_EQ(whole.points.size(), 2 * half.points.size() - 9);
  const SurfaceModel model = make_surface_model(whole);
  EXPECT_EQ(violations(model), kSoundMirror);
  EXPECT_EQ(model.fine.regions.size(), 1u);
  EXPECT_EQ(model.fine.curves.size(), 4u);
}

TEST(Mirror, LinesAreMirroredButThoseInThePlane) {
  Mesh half = triangle_grid(2, 2, 1, 1);
  half.lines = {{0, 1}, {0, 3}};  // along y = 0 and along x = 0
  half.line_curve = {0, 1};
  half.curves = {{1, {"bottom"}}, {2, {"cut"}}};
  ASSERT_EQ(half.points[3].x, 0);
  const Mesh whole = add_mirror_image(half, kLeftSide, "grid");
  ASSERT_EQ(whole.lines.size(), 2u);
  EXPECT_EQ(whole.line_curve, (std::vector<int>{0, 0}));
  EXPECT_EQ(whole.points[whole.lines[1][1]], (Vec3{-0.5, 0, 0}));
}

TEST(Mirror, WhatIsNoHalfIsRefused) {
  const Mesh half = open_box();
  expect_input_error(
      [&] {
        add_mirror_image(half, {{0.5, 0, 0}, {1, 0, 0}, 1e-9}, "box.stl");
      },
      {"box.stl", "both sides", "0.5"});
  expect_input_error(
      [&] {
        add_mirror_image(half, {{-1, 0, 0}, {1, 0, 0}, 1e-9}, "box.stl");
      },
      {"box.stl", "no open edge"});
  Mesh flat = triangle_grid(2, 2, 1, 1);
  expect_input_error(
      [&] {
        add_mirror_image(flat, {{0, 0, 0}, {0, 0, 1}, 1e-9}, "flat.stl");
      },
      {"flat.stl", "lies in the mirror's plane"});
}

}  // namespace
}  // namespace delquad
