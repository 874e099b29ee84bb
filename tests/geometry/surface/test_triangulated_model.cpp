// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"
#include "tests/support/surface_model_checks.h"

namespace delquad {
namespace {

const std::vector<std::string> kSoundModel;

SurfaceModel triangulated(const Mesh& mesh, double feature_angle = 40) {
  return make_surface_model(mesh, {.feature_angle = feature_angle, .source = "case.off"});
}

TEST(TriangulatedModel, BoxIsCutAtItsFeatures) {
  const SurfaceModel model = triangulated(without_regions(box(3)));
  expect_counts(model, 6, 12, 8);
  EXPECT_EQ(model.fine.lines.size(), 12u * 3);
  EXPECT_TRUE(model.warnings.empty());
  std::vector<int> tags;
  for (const Entity& face : model.fine.regions) tags.push_back(face.tag);
  EXPECT_EQ(tags, (std::vector<int>{1, 2, 3, 4, 5, 6}));
}

TEST(TriangulatedModel, AboveTheDihedralAngleABoxIsOneFaceWithoutCurves) {
  expect_counts(triangulated(without_regions(box(3)), 91), 1, 0, 0);
}

TEST(TriangulatedModel, RegionsCutWhereNothingIsSharp) {
  const SurfaceModel model = triangulated(box(3), 91);
  expect_counts(model, 6, 12, 8);
}

TEST(TriangulatedModel, CanHasTwoClosedCurvesWithoutCorners) {
  expect_counts(triangulated(without_regions(can(24, 3))), 3, 2, 0);
  // Where the wall turns by 60 degrees at a step, it is six faces and the circles have corners.
  expect_counts(triangulated(without_regions(can(6, 3))), 8, 18, 12);
}

TEST(TriangulatedModel, OutlineHasCornersWhereItTurns) {
  Mesh square = triangle_grid(4, 4);
  square.lines.clear();
  square.line_curve.clear();
  square.curves.clear();
  expect_counts(triangulated(square), 1, 4, 4);
  expect_counts(triangulated(square, 91), 1, 1, 0);
}

TEST(TriangulatedModel, GivenCurvesAndRegionsKeepTagsAndNames) {
  Mesh square = triangle_grid(4, 4);
  square.regions = {{7, {"plate"}}};
  square.curves[0].tag = 30;
  const SurfaceModel model = triangulated(square, 91);
  expect_counts(model, 1, 4, 4);
  EXPECT_EQ(model.fine.regions[0].tag, 7);
  EXPECT_EQ(model.fine.regions[0].names, (std::vector<std::string>{"plate"}));
  const auto south = std::find_if(model.fine.curves.begin(), model.fine.curves.end(),
                                  [](const Entity& e) { return e.tag == 30; });
  ASSERT_NE(south, model.fine.curves.end());
  EXPECT_EQ(south->names, (std::vector<std::string>{"south"}));
}

TEST(TriangulatedModel, PiecesOfARegionShareItsNames) {
  // Two squares apart, one region; a line across the second cuts it.
  Mesh mesh = triangle_grid(2, 2);
  const int n = append(mesh, mesh, {3, 0, 0});
  mesh.lines = {{n + 3, n + 4}, {n + 4, n + 5}};
  mesh.line_curve = {0, 0};
  mesh.curves = {{5, {"across"}}};
  mesh.regions = {{2, {"both"}}};
  const SurfaceModel model = triangulated(mesh);
  // Outlines: four sides of the first; the second has its left and right sides cut in two, and the line.
  expect_counts(model, 3, 4 + 6 + 1, 4 + 6);
  std::vector<int> tags;
  for (const Entity& face : model.fine.regions) {
    tags.push_back(face.tag);
    EXPECT_EQ(face.names, (std::vector<std::string>{"both"}));
  }
  EXPECT_EQ(tags, (std::vector<int>{2, 3, 4}));
}

TEST(TriangulatedModel, KeptFeaturesStayWhereverTheyLead) {
  // A ridge from the southern side, which fades away to the north: no part of it bounds a face.
  Mesh mesh = triangle_grid(8, 8);
  for (Vec3& p : mesh.points) p.z = 0.7 * (0.5 - std::abs(p.x - 0.5)) * (1 - p.y);
  const auto n_lines = [&](const std::vector<FeatureBall>& balls) {
    TriangulatedOptions options;
    options.kept_features = balls;
    return make_surface_model(mesh, options).fine.lines.size();
  };
  EXPECT_EQ(n_lines({}), 32U) << "the outline";
  EXPECT_EQ(n_lines({{{0.5, 0, 0.35}, 0.3}}), 33U) << "and the edge of more than 60 degrees";
  EXPECT_EQ(n_lines({{{0, 0, 0}, 0.3}}), 32U);
}

TEST(TriangulatedModel, GivenLinesThatEndInsideAFaceBoundNothing) {
  Mesh mesh = triangle_grid(4, 4);
  mesh.lines = {{10, 11}, {11, 12}};  // from the left part of the middle row to its middle
  mesh.line_curve = {0, 0};
  mesh.curves = {{1, {"scratch"}}};
  const SurfaceModel model = triangulated(mesh);
  expect_counts(model, 1, 4, 4);
  ASSERT_EQ(model.loose.size(), 1u);
  EXPECT_EQ(model.loose[0].names, std::vector<std::string>{"scratch"});
  EXPECT_EQ(model.loose[0].points, (std::vector<Vec3>{mesh.points[10], mesh.points[11], mesh.points[12]}));
  // One that crosses all of the face stays.
  mesh.lines = {{10, 11}, {11, 12}, {12, 13}, {13, 14}};
  mesh.line_curve.assign(4, 0);
  expect_counts(triangulated(mesh), 2, 7, 6);
}

TEST(TriangulatedModel, FeaturesThatFadeAreDropped) {
  // A roof whose ridge is sharp at one end and flat at the other.
  Mesh roof = triangle_grid(4, 4, 2, 2);
  roof.lines.clear();
  roof.line_curve.clear();
  roof.curves.clear();
  for (Vec3& p : roof.points) p.z = -std::abs(p.x - 1) * p.y / 2;
  expect_counts(triangulated(roof), 1, 5, 5);  // the gable has a corner
  for (Vec3& p : roof.points) p.z = -std::abs(p.x - 1);
  expect_counts(triangulated(roof), 2, 7, 6);
}

TEST(TriangulatedModel, SeamOfATubeStays) {
  Mesh tube = can(12, 2);
  size_t wall = 0;
  while (tube.triangle_region[wall] == 0) ++wall;
  tube.triangles.resize(wall);
  tube.triangle_region.resize(wall);
  tube.lines = {{tube.triangles[0][0], tube.triangles[1][2]}, {tube.triangles[2][0], tube.triangles[3][2]}};
  tube.line_curve = {0, 0};
  tube.curves = {{9, {"seam"}}};
  expect_counts(triangulated(tube), 1, 3, 2);
}

TEST(TriangulatedModel, SliversMakeNoFeatures) {
  // A point just beside the edge of a flat face, out of its plane by as much as single precision leaves.
  Mesh mesh = without_regions(box(1));
  for (int k = 0; k < 3; ++k) {
    auto& v = mesh.triangles[0];
    const int a = v[k], b = v[(k + 1) % 3], c = v[(k + 2) % 3];
    const Vec3 &p = mesh.points[a], &q = mesh.points[b];
    if (norm(p - q) < 1.2) continue;  // the diagonal
    mesh.points.push_back(0.5 * (p + q) + Vec3{2e-8, 3e-8, -3e-8});
    const int m = static_cast<int>(mesh.points.size()) - 1;
    v = {a, m, c};
    mesh.triangles.push_back({m, b, c});
    mesh.triangles.push_back({a, b, m});
    break;
  }
  mesh.triangle_region.assign(mesh.triangles.size(), 0);
  ASSERT_EQ(mesh.triangles.size(), 14u);
  expect_counts(triangulated(mesh), 6, 12, 8);
}

TEST(TriangulatedModel, SplitBoundaryOfAMoebiusBandIsRefused) {
  Mesh band;
  constexpr int n = 12;
  for (int i = 0; i < n; ++i) {
    const double t = 2 * std::numbers::pi * i / n;
    for (const double s : {-0.3, 0.3}) {
      const double r = 1 + s * std::cos(t / 2);
      band.points.push_back({r * std::cos(t), r * std::sin(t), s * std::sin(t / 2)});
    }
  }
  for (int i = 0; i < n; ++i) {
    const int a = 2 * i, b = a + 1, c = i + 1 < n ? a + 2 : 1, d = i + 1 < n ? a + 3 : 0;
    band.triangles.push_back({a, c, b});
    band.triangles.push_back({b, c, d});
  }
  band.regions = {{1, {}}};
  band.triangle_region.assign(band.triangles.size(), 0);
  expect_input_error([&] { triangulated(band); }, {"case.off: ", "one side only", "edge from ("});
}

TEST(TriangulatedModel, TheSameInputGivesTheSameModel) {
  const SurfaceModel a = triangulated(without_regions(can(24, 3))),
                     b = triangulated(without_regions(can(24, 3)));
  EXPECT_EQ(a.fine.points, b.fine.points);
  EXPECT_EQ(a.fine.triangles, b.fine.triangles);
  EXPECT_EQ(a.fine.lines, b.fine.lines);
}

TEST(TriangulatedModel, FeatureAngleOutOfRangeIsRefused) {
  for (const double angle : {0.0, -1.0, 181.0, std::nan("")}) {
    EXPECT_THROW(triangulated(box(1), angle), std::invalid_argument) << angle;
  }
}

TEST(TriangleRepair, SoupIsWeldedAtItsOpenEdges) {
  const SurfaceModel model = triangulated(without_regions(soup(box(2))));
  expect_counts(model, 6, 12, 8);
  EXPECT_EQ(model.fine.points.size(), box(2).points.size());
  EXPECT_TRUE(is_reported(model.warnings, "welded"));
}

TEST(TriangleRepair, GapsAreWeldedWithinTheToleranceOrReported) {
  Mesh mesh = soup(without_regions(box(2)));
  for (size_t i = 0; i < mesh.points.size(); ++i) mesh.points[i].x += 1e-7 * double(i % 3);
  const SurfaceModel open = triangulated(mesh);
  EXPECT_GT(open.fine.regions.size(), 6u);
  // Two ten-millionths, of a diagonal of the root of three, rounded up.
  EXPECT_TRUE(is_reported(open.warnings, "no more than 2e-07 from others"));
  EXPECT_TRUE(is_reported(open.warnings, "--weld 2e-07 (weld_tolerance, a part of the diagonal) closes"));
  const SurfaceModel closed = make_surface_model(mesh, {.weld_tolerance = 2e-7});
  expect_counts(closed, 6, 12, 8);
  EXPECT_FALSE(is_reported(closed.warnings, "--weld"));
}

TEST(TriangleRepair, WeldingIsNotAdvisedWhereItClosesNothing) {
  // Two boxes that touch at an open corner: parted there, they have points at the same place.
  Mesh mesh;
  mesh.regions = {{1, {}}};
  for (const double at : {0.0, 1.0}) {
    const Mesh cube = box(1);
    const int n = static_cast<int>(mesh.points.size());
    for (const Vec3& p : cube.points) mesh.points.push_back(p + Vec3{at, at, at});
    bool is_open = false;
    for (const auto& v : cube.triangles) {
      const bool touches = std::ranges::any_of(v, [&](int i) {
        return cube.points[i] == Vec3{1 - at, 1 - at, 1 - at};
      });
      if (touches && !std::exchange(is_open, true)) continue;
      mesh.triangles.push_back({v[0] + n, v[1] + n, v[2] + n});
      mesh.triangle_region.push_back(0);
    }
  }
  const SurfaceModel model = triangulated(mesh);
  EXPECT_TRUE(is_reported(model.warnings, "parted the surface where it touched itself"));
  EXPECT_FALSE(is_reported(model.warnings, "weld tolerance"));
  EXPECT_FALSE(is_reported(model.warnings, "--weld"));
}

/// Boxes of n x n squares a side that share their nodes at x = 1. There the squares of the second one have
/// the other diagonals, and its nodes inside of the face lie at 1 + bulge.
Mesh touching_boxes(int n, double bulge) {
  TriangulatedShape both;
  both.region();
  both.mesh.regions[0].names = {"left"};
  const Mesh mesh = box(n);
  const auto mirrored = [&](int v) {
    const Vec3& p = mesh.points[v];
    const bool is_inside = p.x == 0 && p.y > 0 && p.y < 1 && p.z > 0 && p.z < 1;
    return Vec3{1 + p.x + (is_inside ? bulge : 0), 1 - p.y, p.z};
  };
  for (const auto& [a, b, c] : mesh.triangles) both.triangle(mesh.points[a], mesh.points[b], mesh.points[c]);
  both.region();
  both.mesh.regions[1].names = {"right"};
  for (const auto& [a, b, c] : mesh.triangles) both.triangle(mirrored(a), mirrored(c), mirrored(b));
  return both.mesh;
}

TEST(TriangleRepair, OneFaceStaysWhereBodiesTouchWithOtherDiagonals) {
  for (const int n : {1, 3}) {
    const SurfaceModel model = triangulated(touching_boxes(n, 0));
    expect_counts(model, 11, 20, 12);
    EXPECT_EQ(model.fine.triangles.size(), 11u * 2 * n * n);
    const std::vector<std::string> names = {"left", "right"};
    EXPECT_EQ(std::ranges::count(model.fine.regions, names, &Entity::names), 1);
    EXPECT_TRUE(is_reported(model.warnings, fmt::format("left out {} triangles of {} that lie on others",
                                                        2 * n * n, n == 1 ? "1 flat part" : "9 flat parts")));
  }
  expect_counts(triangulated(touching_boxes(3, 0.1)), 12, 20, 12);
}

TEST(TriangleRepair, AFaceOfTwoBodiesHasTheNamesOfBoth) {
  Mesh tetrahedra;
  tetrahedra.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};
  tetrahedra.regions = {{1, {"a"}}, {2, {"b"}}};
  tetrahedra.triangles = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0},
                          {0, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 0, 4}};
  tetrahedra.triangle_region = {0, 0, 0, 0, 1, 1, 1, 1};
  const SurfaceModel model = triangulated(tetrahedra);
  std::map<std::vector<std::string>, int> faces;
  for (const Entity& region : model.fine.regions) ++faces[region.names];
  EXPECT_EQ(faces, (std::map<std::vector<std::string>, int>{{{"a"}, 3}, {{"b"}, 3}, {{"a", "b"}, 1}}));
}

TEST(TriangleRepair, SmallFoldsWithoutThicknessGo) {
  const auto with_fin = [](double height) {
    Mesh mesh = without_regions(box(48));
    const auto [a, b, c] = mesh.triangles[20];
    const int tip = static_cast<int>(mesh.points.size());
    mesh.points.push_back(0.5 * (mesh.points[a] + mesh.points[b]) + Vec3{height, 2 * height, height});
    mesh.triangles.insert(mesh.triangles.end(), {{a, b, tip}, {b, a, tip}});
    mesh.triangle_region.insert(mesh.triangle_region.end(), 2, 0);
    return triangulated(mesh);
  };
  const SurfaceModel small = with_fin(-1e-3);
  expect_counts(small, 6, 12, 8);
  EXPECT_TRUE(is_reported(small.warnings, "left out 2 triangles in small folds without thickness"));
  EXPECT_EQ(with_fin(-0.5).fine.triangles.size(), small.fine.triangles.size() + 1);
}

TEST(TriangleRepair, DegenerateAndDuplicateTrianglesAndUnusedPointsGo) {
  Mesh mesh = without_regions(box(2));
  const auto first = mesh.triangles[0];
  mesh.triangles.push_back({first[0], first[1], first[0]});
  mesh.triangles.push_back({first[1], first[2], first[0]});
  mesh.triangles.push_back({first[1], first[0], first[2]});
  mesh.points.push_back({9, 9, 9});
  mesh.triangle_region.assign(mesh.triangles.size(), 0);
  const SurfaceModel model = triangulated(mesh);
  expect_counts(model, 6, 12, 8);
  EXPECT_EQ(model.fine.triangles.size(), box(2).triangles.size());
  EXPECT_TRUE(is_reported(model.warnings, "left out 1 triangle without area (the first at (0, "));
  EXPECT_TRUE(is_reported(model.warnings, "left out 2 triangles on the vertices of another"));
  EXPECT_TRUE(is_reported(model.warnings, "left out 1 point that no triangle uses"));
}

TEST(TriangleRepair, FlatTrianglesLeaveNoGap) {
  // One side of the box refined on its edge only: the other side keeps the long edge, flat triangles fill it.
  Mesh mesh = without_regions(box(1));
  auto& v = mesh.triangles[0];
  int k = 0;
  while (norm(mesh.points[v[(k + 1) % 3]] - mesh.points[v[k]]) > 1.2) ++k;
  const int a = v[k], b = v[(k + 1) % 3], c = v[(k + 2) % 3], m = static_cast<int>(mesh.points.size());
  for (const double s : {0.25, 0.5, 0.75})
    mesh.points.push_back(mesh.points[a] + s * (mesh.points[b] - mesh.points[a]));
  v = {a, m, c};
  mesh.triangles.insert(mesh.triangles.end(), {{m, m + 1, c},
                                               {m + 1, m + 2, c},
                                               {m + 2, b, c},  // cut
                                               {a, b, m + 2},
                                               {a, m + 2, m + 1},
                                               {a, m + 1, m}});  // flat
  mesh.triangle_region.assign(mesh.triangles.size(), 0);
  const SurfaceModel model = triangulated(mesh);
  expect_counts(model, 6, 12, 8);
  EXPECT_NEAR(volume(model.fine), 1, 1e-12);
  EXPECT_TRUE(is_reported(model.warnings, "left out 3 triangles without area"));
}

TEST(TriangleRepair, NeedlesOfSinglePrecisionThatHangOnAnEdge) {
  Mesh mesh = without_regions(box(1));
  const auto [a, b, c] = mesh.triangles[0];
  const int m = static_cast<int>(mesh.points.size());
  mesh.points.push_back(0.5 * (mesh.points[a] + mesh.points[b]) + Vec3{1e-8, 1e-8, 1e-8});
  mesh.triangles.insert(mesh.triangles.end(), 3, {a, b, m});
  mesh.triangle_region.assign(mesh.triangles.size(), 0);
  const SurfaceModel model = triangulated(mesh);
  expect_counts(model, 6, 12, 8);
  EXPECT_NEAR(volume(model.fine), 1, 1e-7);
  EXPECT_TRUE(is_reported(model.warnings, "left out 1 triangle without area"));
}

TEST(TriangleRepair, AFlatTriangleOnAGivenCurveCutsItsLine) {
  Mesh mesh = triangle_grid(1, 1);
  mesh.points.push_back({0.5, 0, 0});
  mesh.triangles[0] = {0, 4, 3};
  mesh.triangles.push_back({4, 1, 3});
  mesh.triangles.push_back({0, 1, 4});
  // The square again below the line, so that the flat triangle lies between two faces.
  mesh.points.insert(mesh.points.end(), {{0, -1, 0}, {1, -1, 0}});
  mesh.triangles.push_back({5, 1, 0});
  mesh.triangles.push_back({5, 6, 1});
  mesh.triangle_region = {0, 0, 0, 0, 1, 1};
  mesh.regions = {{1, {}}, {2, {}}};
  mesh.lines = {{0, 1}};
  mesh.line_curve = {0};
  mesh.curves = {{4, {"middle"}}};
  const SurfaceModel model = triangulated(mesh);
  expect_counts(model, 2, 7, 6);
  const auto is_middle = [](const Entity& e) { return e.names == std::vector<std::string>{"middle"}; };
  const auto middle = std::find_if(model.fine.curves.begin(), model.fine.curves.end(), is_middle);
  ASSERT_NE(middle, model.fine.curves.end());
  EXPECT_EQ(std::count(model.fine.line_curve.begin(), model.fine.line_curve.end(),
                       static_cast<int>(middle - model.fine.curves.begin())),
            2);
}

TEST(TriangleRepair, OrientationFollowsTheMajorityAndFacesOutwards) {
  Mesh mesh = without_regions(box(2));
  for (size_t t = 0; t < mesh.triangles.size(); t += 5) std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
  const SurfaceModel some = triangulated(mesh);
  EXPECT_NEAR(volume(some.fine), 1, 1e-12);
  EXPECT_TRUE(is_reported(some.warnings, "turned over 10 triangles"));

  Mesh inwards = without_regions(box(2));
  for (auto& v : inwards.triangles) std::swap(v[0], v[1]);
  const SurfaceModel all = triangulated(inwards);
  EXPECT_NEAR(volume(all.fine), 1, 1e-12);
  EXPECT_TRUE(is_reported(all.warnings, "turned outwards 1 closed surface"));
}

TEST(TriangleRepair, ACavityKeepsFacingInwards) {
  Mesh mesh = without_regions(box(2));
  const int n = static_cast<int>(mesh.points.size());
  const Mesh inner = mesh;
  for (const Vec3& p : inner.points) mesh.points.push_back(0.5 * p + Vec3{0.25, 0.25, 0.25});
  for (const auto& v : inner.triangles) mesh.triangles.push_back({v[0] + n, v[2] + n, v[1] + n});
  mesh.triangle_region.assign(mesh.triangles.size(), 0);
  const SurfaceModel model = triangulated(mesh);
  expect_counts(model, 12, 24, 16);
  EXPECT_NEAR(volume(model.fine), 1 - 0.125, 1e-12);
}

TEST(TriangleRepair, SurfacesThatTouchAtAVertexAreParted) {
  Mesh mesh = without_regions(box(1));
  const int n = static_cast<int>(mesh.points.size());
  const Mesh other = mesh;
  int shared = -1, touching = -1;
  for (int i = 0; i < n; ++i) {
    if (other.points[i] == Vec3{1, 1, 1}) shared = i;
    if (other.points[i] == Vec3{0, 0, 0}) touching = i;
    mesh.points.push_back(other.points[i] + Vec3{1, 1, 1});
  }
  for (const auto& v : other.triangles) {
    std::array<int, 3> w{};
    for (int k = 0; k < 3; ++k) w[k] = v[k] == touching ? shared : v[k] + n;
    mesh.triangles.push_back(w);
  }
  mesh.triangle_region.assign(mesh.triangles.size(), 0);
  const SurfaceModel model = triangulated(mesh);
  expect_counts(model, 12, 24, 16);
  EXPECT_EQ(model.fine.points.size(), 16u);
  EXPECT_TRUE(is_reported(model.warnings, "touched itself at a vertex: 1 time (the first at (1, 1, 1))"));
}

TEST(TriangleRepair, BranchingEdgesAreCurves) {
  Mesh mesh = triangle_grid(1, 1);
  mesh.points.push_back({0.5, 0.5, 1});
  mesh.triangles.push_back({0, 3, 4});
  mesh.triangle_region.push_back(0);
  const SurfaceModel model = triangulated(mesh);
  EXPECT_EQ(model.fine.regions.size(), 3u);
  EXPECT_EQ(model.fine.points.size(), 5u) << "the sheets share the edge's ends";
  EXPECT_EQ(violations(model), kSoundModel);
  EXPECT_TRUE(is_reported(model.warnings,
                          "branches at 1 edge with three triangles or more (the first at (0, 0, 0))"));
  EXPECT_TRUE(is_reported(model.warnings, "more than two faces meet on curves: 1 ("));
}

TEST(TriangleRepair, SidesOfCellsAreRefused) {
  Mesh mesh;
  for (int i = 0; i < 6; ++i) mesh.points.push_back({1.0 * i, 1.0 * i * i, 1.0 * i * i * i});
  mesh.regions = {{1, {}}};
  for (int a = 0; a < 6; ++a)
    for (int b = a + 1; b < 6; ++b)
      for (int c = b + 1; c < 6; ++c) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangle_region.push_back(0);
      }
  expect_input_error([&] { triangulated(mesh); }, {"case.off: 15 of 15 edges", "cells in a volume"});
}

/// A rough plate; with `peg`, a square one of machined edges stands on it.
Mesh rough_plate(int n, double roughness, bool peg) {
  Mesh mesh = triangle_grid(n, n, n, n);
  std::mt19937 random(3);
  for (Vec3& p : mesh.points) {
    const bool on_peg = std::abs(p.x - n / 2.0) < 0.8 && std::abs(p.y - n / 2.0) < 0.8;
    const double noise = roughness * (static_cast<double>(random() % 1000) / 1000 - 0.5);
    p.z = peg && on_peg ? 5 : noise;
  }
  mesh.lines.clear();
  mesh.line_curve.clear();
  mesh.curves.clear();
  return without_regions(mesh);
}

TEST(TriangulatedModel, NoiseMakesNoFeatures) {
  const SurfaceModel model = triangulated(rough_plate(60, 0.65, false), 40);
  EXPECT_TRUE(is_reported(model.warnings, "of sharp edges as noise")) << "the test has none";
  EXPECT_EQ(model.fine.regions.size(), 1u);
  EXPECT_EQ(violations(model), kSoundModel);
}

TEST(TriangulatedModel, SmallFeaturesOfSmoothPartsStay) {
  const SurfaceModel model = triangulated(rough_plate(60, 0, true), 40);
  EXPECT_FALSE(is_reported(model.warnings, "noise"));
  EXPECT_GT(model.fine.regions.size(), 1u);
}

TEST(TriangleRepair, WhatIsNoSurfaceOfTrianglesIsRefused) {
  Mesh nan = triangle_grid(1, 1);
  nan.points[2].y = std::numeric_limits<double>::quiet_NaN();
  expect_input_error([&] { triangulated(nan); }, {"case.off: point 3", "finite"});
  expect_input_error([&] { triangulated(quad_grid(2, 2)); }, {"case.off: 4 quads", "triangles"});
  expect_input_error([&] { triangulated(Mesh{}); }, {"case.off: no triangles"});
  Mesh flat = triangle_grid(2, 2, 1, 0);
  expect_input_error([&] { triangulated(flat); }, {"case.off: no triangle has an area"});
}

TEST(TriangleRepair, DamagedSurfacesBecomeSoundModels) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 600; ++trial) {
    Mesh mesh = trial % 2 == 0 ? box(2) : can(8, 2);
    for (unsigned changes = 1 + random() % 4; changes > 0; --changes) {
      const size_t t = random() % mesh.triangles.size();
      const int v = static_cast<int>(random() % mesh.points.size());
      const size_t kind = random() % 6;
      if (kind == 0) mesh.triangles[t][random() % 3] = v;
      if (kind == 1) std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
      if (kind == 2) mesh.points[mesh.triangles[t][0]] = mesh.points[mesh.triangles[t][1]];
      if (kind == 3) mesh.triangle_region[t] = 0;
      if (kind == 4)
        mesh.points[v] = 0.5 * (mesh.points[mesh.triangles[t][0]] + mesh.points[mesh.triangles[t][1]]);
      if (kind == 5) {
        mesh.triangles.erase(mesh.triangles.begin() + static_cast<long>(t));
        mesh.triangle_region.erase(mesh.triangle_region.begin() + static_cast<long>(t));
      }
    }
    EXPECT_EQ(violations(triangulated(mesh)), kSoundModel) << "trial " << trial;
  }
}

TEST(TriangleRepair, LinesOffTheTrianglesGo) {
  Mesh mesh = triangle_grid(2, 2);
  mesh.lines.push_back({0, 8});
  mesh.lines.push_back(mesh.lines[0]);
  mesh.line_curve.insert(mesh.line_curve.end(), {0, 0});
  const SurfaceModel model = triangulated(mesh);
  expect_counts(model, 1, 4, 4);
  EXPECT_TRUE(is_reported(model.warnings, "left out 1 line along no side"));
}

// A wall that stands on a floor, and leaves it in the middle without a turn.
TEST(TriangulatedModel, BranchingEndsInsideACurve) {
  TriangulatedShape shape;
  const auto quad = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    shape.triangle(a, b, c);
    shape.triangle(a, c, d);
  };
  shape.region();
  for (const double y : {0.0, 1.0})
    for (const double x : {-1.0, 0.0}) quad({x, y, 0}, {x + 1, y, 0}, {x + 1, y + 1, 0}, {x, y + 1, 0});
  quad({0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1});
  quad({0, 1, 0}, {0, 2, 0.05}, {0, 2, 1}, {0, 1, 1});
  const SurfaceModel model = make_surface_model(shape.mesh);
  EXPECT_EQ(violations(model), std::vector<std::string>{});
  EXPECT_TRUE(is_reported(model.warnings, "branches at 1 edge with three triangles or more"));
}

}  // namespace
}  // namespace delquad
