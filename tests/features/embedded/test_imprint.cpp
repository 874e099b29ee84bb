// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/embedded/imprint.h"
#include "geometry/mesh/check_invariants.h"
#include "geometry/surface/flatten.h"
#include "tests/support/flat_patch_checks.h"
#include "tests/support/meshing.h"
#include "tests/support/named_lines.h"

namespace delquad {
namespace {

const auto size_of_tenth = make_constant_size(0.1);

LooseLine asked(std::vector<Vec3> points, const std::string& name) {
  return {std::move(points), {name}, "the line '" + name + "'", true};
}

/// A unit square of 4 x 4 cells.
SurfaceModel square() { return make_surface_model(triangle_grid(4, 4)); }

SurfaceModel imprinted(SurfaceModel model, std::vector<LooseLine> lines) {
  model.loose = std::move(lines);
  imprint(model, *size_of_tenth);
  EXPECT_TRUE(model.loose.empty());
  EXPECT_EQ(check_invariants(model.fine), std::vector<std::string>{});
  expect_sound_curves(model);
  return model;
}

double area_of(const Mesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += norm(cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a])) / 2;
  return sum;
}

int corner_at(const SurfaceModel& model, const Vec3& x) {
  for (const int v : model.corners)
    if (norm(model.fine.points[v] - x) < 1e-12) return v;
  return -1;
}

TEST(Imprint, LinesThatCrossShareACorner) {
  const SurfaceModel model = imprinted(
      square(), {asked({{0.1, 0.15, 0}, {0.9, 0.75, 0}}, "a"), asked({{0.1, 0.75, 0}, {0.9, 0.15, 0}}, "b")});
  EXPECT_NEAR(length_named(model.fine, "a"), 1, 1e-12);
  EXPECT_NEAR(length_named(model.fine, "b"), 1, 1e-12);
  EXPECT_NEAR(area_of(model.fine), 1, 1e-12);
  EXPECT_EQ(model.embedded.size(), 2u);
  EXPECT_GE(corner_at(model, {0.5, 0.45, 0}), 0);
}

TEST(Imprint, AcrossASharpEdgeALineHasAPieceInEachFace) {
  Mesh roof = triangle_grid(4, 4);
  roof.lines.clear();
  roof.line_curve.clear();
  roof.curves.clear();
  for (Vec3& p : roof.points) p.z = 2 * std::min(p.x, 1 - p.x);
  const SurfaceModel model =
      imprinted(make_surface_model(roof), {asked({{0.2, 0.4, 0.4}, {0.8, 0.4, 0.4}}, "over")});
  ASSERT_EQ(model.embedded.size(), 2u);
  EXPECT_NE(model.embedded[0].face, model.embedded[1].face);
  EXPECT_GE(corner_at(model, {0.5, 0.4, 1}), 0);
  EXPECT_NEAR(length_named(model.fine, "over"), 2 * std::hypot(0.3, 0.6), 1e-12);
}

TEST(Imprint, OnASphereSegmentsAreInOnePlaneAndGreatCirclesNearly) {
  const Vec3 a{1, 0, 0}, b{0.6, 0, 0.8};
  const SurfaceModel model = imprinted(round_sphere(8), {asked({a, b}, "arc")});
  const Mesh& mesh = model.fine;
  ASSERT_GT(mesh.lines.size(), 3u);
  const Vec3 first = mesh.points[mesh.lines.front()[0]], last = mesh.points[mesh.lines.back()[1]];
  const Vec3 across = cross(last - first, mesh.points[mesh.lines[mesh.lines.size() / 2][0]] - first);
  for (const auto& line : mesh.lines)
    for (const int v : line) {
      EXPECT_NEAR(dot(across, mesh.points[v] - first), 0, 1e-6 * norm(across));
      EXPECT_NEAR(mesh.points[v].y, 0, 5e-4);
    }
  EXPECT_NEAR(length_named(mesh, "arc"), std::acos(0.6), 1e-2);
}

TEST(Imprint, APointHasEdgesToBothSidesAndItsName) {
  const SurfaceModel model = imprinted(square(), {asked({{0.4, 0.3, 0}}, "sensor")});
  ASSERT_EQ(model.fine.named_points.size(), 1u);
  const int v = model.fine.named_points[0].point;
  EXPECT_EQ(corner_at(model, {0.4, 0.3, 0}), v);
  EXPECT_EQ(model.fine.named_points[0].entity.names, std::vector<std::string>{"sensor"});
  int lines = 0;
  for (const auto& [a, b] : model.fine.lines) lines += a == v || b == v;
  EXPECT_EQ(lines, 2);
}

TEST(Imprint, PatchesAreCutOpenAlongLines) {
  // An island, a line from the border, one that divides the face, and a point.
  SurfaceModel model = imprinted(
      square(), {asked({{0.2, 0.2, 0}, {0.3, 0.3, 0}}, "island"), asked({{0, 0.6, 0}, {0.3, 0.6, 0}}, "spur"),
                 asked({{0.7, 0, 0}, {0.75, 1, 0}}, "wall"), asked({{0.85, 0.5, 0}}, "point")});
  const Flattening flattening = flatten(model);
  EXPECT_TRUE(flattening.failed.empty());
  EXPECT_TRUE(flattening.cuts.empty());
  ASSERT_EQ(flattening.patches.size(), 2u);
  double flat = 0;
  std::size_t loops = 0;
  for (const FlatPatch& patch : flattening.patches) {
    EXPECT_EQ(check_invariants(patch.flat), std::vector<std::string>{});
    loops += patch.loops.size();
    for (const auto& [a, b, c] : patch.flat.triangles)
      flat +=
          cross(patch.flat.points[b] - patch.flat.points[a], patch.flat.points[c] - patch.flat.points[a]) / 2;
    std::set<std::pair<double, double>> places;
    for (int v = 0; v < patch.flat.n_boundary; ++v)
      EXPECT_TRUE(places.insert({patch.flat.points[v].x, patch.flat.points[v].y}).second);
  }
  EXPECT_EQ(loops, 4u);
  EXPECT_NEAR(flat, 1, 1e-5);
  EXPECT_LT(flat, 1);
}

TEST(Imprint, WhatDoesNotFitIsRefused) {
  const auto refused = [](std::vector<LooseLine> lines, std::initializer_list<const char*> parts) {
    expect_input_error([&] { imprinted(square(), std::move(lines)); }, parts);
  };
  refused({asked({{0.5, 0.5, 0.25}}, "high")},
          {"the line 'high' is 0.25 away", "(0.5, 0.5, 0.25)", "0.001414"});
  refused({asked({{0.5, 0.5, 0}, {0.5, 0.5, 0}}, "dot")}, {"'dot' has length zero at (0.5, 0.5, 0)"});
  refused({asked({{0.1, 0, 0}, {0.9, 0, 0}}, "rim")}, {"'rim' runs along curve 1", "(0.1, 0, 0)"});
  refused({asked({{0.5, 0.5, 0}}, "p"), asked({{0.5, 0.50005, 0}}, "q")},
          {"'q'", "5e-05 from one of the line 'p'"});
  refused({asked({{0.1, 0.1, 0}, {0.4, 0.1, 0}}, "once"), asked({{0.1, 0.1, 0}, {0.4, 0.1, 0}}, "twice")},
          {"'twice' runs along curve", "'once'"});
}

TEST(Imprint, LinesOfAFileThatLieElsewhereAreNamed) {
  LooseLine line = asked({{0.5, 0.5, 1}, {0.6, 0.5, 1}}, "far");
  line.is_requested = false;
  const SurfaceModel model = imprinted(square(), {line});
  EXPECT_TRUE(model.embedded.empty());
  ASSERT_FALSE(model.warnings.empty());
  EXPECT_TRUE(holds(model.warnings.back().text, "the line 'far' is left out: it is 1 away"));
}

TEST(Imprint, PointsOfAFileWithoutRoomStayNoNodes) {
  const LooseLine line = asked({{0.1, 0.15, 0}, {0.9, 0.75, 0}}, "line");
  LooseLine near = asked({{0.5, 0.45 + 1e-5, 0}}, "near"), far = asked({{0.2, 0.8, 0}}, "far");
  near.is_requested = far.is_requested = false;
  const SurfaceModel model = imprinted(square(), {line, near, far});
  ASSERT_EQ(model.fine.named_points.size(), 1u);
  EXPECT_EQ(model.fine.named_points[0].entity.names[0], "far");
  EXPECT_LT(corner_at(model, near.points[0]), 0);
  EXPECT_GE(corner_at(model, far.points[0]), 0);
  EXPECT_TRUE(
      holds(model.warnings.back().text, "the line 'near' is left out: it is nearer than a thousandth"));
  SurfaceModel twice = square();
  twice.loose = {line, near, near};
  twice.loose[2].is_requested = true;
  expect_input_error([&] { imprint(twice, *size_of_tenth); },
                     {"the line 'near' is nearer than a thousandth"});
}

TEST(Imprint, ALineThatLeavesTheSurfaceIsRefused) {
  // A ring: its hole is between the ends.
  SurfaceModel ring = grid_surface({40, 4, true}, [](double u, double v) {
    const double phi = 2 * 3.141592653589793 * u;
    return Vec3{(1 + v) * std::cos(phi), (1 + v) * std::sin(phi), 0};
  });
  ring.loose = {asked({{1.5, 0.1, 0}, {-1.5, 0.1, 0}}, "bridge")};
  expect_input_error([&] { imprint(ring, *size_of_tenth); },
                     {"'bridge' leaves the surface between (1.5, 0.1, 0)"});
}

}  // namespace
}  // namespace delquad
