// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "delquad/mesher.h"
#include "geometry/mesh/entity_names.h"
#include "mesher/prepare.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/meshing.h"
#include "tests/support/named_lines.h"

namespace delquad {
namespace {

/// A plate with a row of holes, symmetric about x = 2 and y = 1; a region fills the hole in the middle.
PlanarModel symmetric_plate() {
  PlanarModel model = polygons({{{0, 0}, {4, 0}, {4, 2}, {0, 2}}});
  model.loops[0].region = "plate";
  for (int i = 0; i < 3; ++i) {
    model.curves.push_back({make_circle({0.8 + 1.2 * i, 1}, 0.35), "hole", {}});
    model.loops.push_back({{static_cast<int>(model.curves.size()) - 1}, i == 1 ? "core" : "", {}});
  }
  return model;
}

PlanarModel named_rectangle() {
  PlanarModel model;
  model.curves = {{make_segment({0, 0}, {4, 0}), "below", {}},
                  {make_segment({4, 0}, {4, 2}), "right", {}},
                  {make_segment({4, 2}, {0, 2}), "above", {}},
                  {make_segment({0, 2}, {0, 0}), "left", {}}};
  model.loops = {{{0, 1, 2, 3}, "plate", {}}};
  return model;
}

MeshProblem symmetric_problem(PlanarModel model, double size, SymmetrySpec spec) {
  MeshProblem problem;
  problem.model = std::move(model);
  problem.size.field = make_constant_size(size);
  problem.symmetry = std::move(spec);
  return problem;
}

/// Every point and every quad, with its region, has its mirror image.
void expect_mirrored(const Mesh& mesh, const std::function<Vec3(Vec3)>& mirror) {
  const auto key = [](const Vec3& x) {
    const auto rounded = [](double v) { return static_cast<long long>(std::llround(v * 1e10)); };
    return std::pair(rounded(x.x), rounded(x.y));
  };
  std::set<std::pair<long long, long long>> points;
  for (const Vec3& x : mesh.points) points.insert(key(x));
  for (const Vec3& x : mesh.points) EXPECT_TRUE(points.contains(key(mirror(x)))) << x.x << ' ' << x.y;
  std::set<std::pair<int, std::pair<long long, long long>>> middles;
  const auto middle = [&](std::size_t q) {
    Vec3 sum;
    for (const int v : mesh.quads[q]) sum = sum + mesh.points[v];
    return 0.25 * sum;
  };
  for (std::size_t q = 0; q < mesh.quads.size(); ++q) middles.insert({mesh.quad_region[q], key(middle(q))});
  for (std::size_t q = 0; q < mesh.quads.size(); ++q)
    EXPECT_TRUE(middles.contains({mesh.quad_region[q], key(mirror(middle(q)))}));
}

double area(const Mesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c, d] : mesh.quads)
    sum += cross(mesh.points[c] - mesh.points[a], mesh.points[d] - mesh.points[b]).z / 2;
  return sum;
}

/// All is meshed, and a warning says so, and what spoils a plane of the outline.
void expect_no_plane(const PlanarModel& model, const std::string& near_miss = "") {
  const MeshResult r = mesh(symmetric_problem(model, 0.2, {{}, true, "s 1"}), "DBCO");
  EXPECT_TRUE(r.soundness.sound());
  EXPECT_NEAR(area(r.mesh), area(mesh(symmetric_problem(model, 0.2, {}), "DBCO").mesh), 0.05);
  EXPECT_TRUE(std::ranges::any_of(r.warnings, [&](const Warning& w) {
    return w.text.starts_with("s 1: no plane of symmetry was found: all of the model is meshed" + near_miss);
  }));
}

Vec3 about_x2(Vec3 x) { return {4 - x.x, x.y, x.z}; }
Vec3 about_y1(Vec3 x) { return {x.x, 2 - x.y, x.z}; }

TEST(Symmetry, EveryNodeHasItsMirrorImage) {
  for (const std::string word : {"DB", "DBCO", "DLBCO"}) {
    const MeshResult one = mesh(symmetric_problem(symmetric_plate(), 0.11, {{{{2, 0, 0}, {1, 0, 0}}}}), word);
    EXPECT_TRUE(one.mesh.triangles.empty());
    expect_mirrored(one.mesh, about_x2);
    const MeshResult two =
        mesh(symmetric_problem(symmetric_plate(), 0.09, {{{{2, 1, 0}, {-3, 0, 0}}, {{2, 1, 0}, {0, 1, 0}}}}),
             word);
    EXPECT_TRUE(two.mesh.triangles.empty());
    expect_mirrored(two.mesh, about_x2);
    expect_mirrored(two.mesh, about_y1);
    EXPECT_EQ(two.mesh.regions.size(), 2u);
  }
}

TEST(Symmetry, EdgesAtSinglePointsAreMirrored) {
  PlanarModel model = polygons({{{0, 0}, {4, 0}, {4, 2}, {0, 2}}});
  for (const double x : {0.53, 3.47})
    for (const double y : {0.41, 1.59}) model.points.push_back({{x, y}, "sensor", {}});
  for (const SymmetrySpec& spec : {SymmetrySpec{{{{2, 1, 0}, {0, 1, 0}}}}, SymmetrySpec{{}, true}}) {
    const MeshResult r = mesh(symmetric_problem(model, 0.1, spec), "DBCO");
    EXPECT_EQ(r.mesh.named_points.size(), 4u);
    expect_mirrored(r.mesh, about_y1);
    if (spec.automatic) expect_mirrored(r.mesh, about_x2);
  }
  model.points[0].at = {0.6, 0.41};
  model.points[0].where = "m 3";
  expect_input_error(
      [&] {
        mesh(symmetric_problem(model, 0.1, {{{{2, 1, 0}, {0, 1, 0}}}, false, "s 1"}), "DBCO");
      },
      {"s 1: the model is not symmetric",
       "the point 'sensor' at (0.6, 0.41, 0) has no mirror image at (0.6, "
       "1.59, 0)"});
  // The other points' planes are none of this one.
  expect_no_plane(
      model,
      "; the plane through (2, 1, 0) with the normal (1, 0, 0) would be one, but the point 'sensor' "
      "at (0.6, 0.41, 0) has no mirror image at (3.4, 0.41, 0)");
}

/// The edges at the second point run askew, past the other ones.
TEST(Symmetry, EdgesAtCrowdedPointsAreMirrored) {
  PlanarModel model = polygons({{{0, 0}, {4, 0}, {4, 2}, {0, 2}}});
  for (const Vec2 at : {Vec2{0.484, 0.875}, {0.539, 0.929}, {0.519, 0.892}})
    for (const double x : {at.x, 4 - at.x}) model.points.push_back({{x, at.y}, "sensor", {}});
  const MeshResult r = mesh(symmetric_problem(model, 0.1, {{{{2, 1, 0}, {1, 0, 0}}}}), "DBCO");
  EXPECT_EQ(r.mesh.named_points.size(), 6u);
  expect_mirrored(r.mesh, about_x2);
}

TEST(Symmetry, CurvesThatSpoilAPlaneAreNamed) {
  PlanarModel model = symmetric_plate();
  model.curves.push_back({make_segment({0.2, 0.2}, {0.2, 1.2}), "rib", "m 4"});
  expect_no_plane(
      model,
      "; the plane through (2, 1, 0) with the normal (1, 0, 0) would be one, but the mirror image of curve 5 "
      "'rib' is 0.2 away from curves at (3.8, ");
}

TEST(Symmetry, PlanesThatAreFoundAreTold) {
  const MeshingSetup p = prepare_problem(symmetric_problem(symmetric_plate(), 0.2, {{}, true}));
  ASSERT_EQ(p.symmetry.size(), 2u);
  EXPECT_NEAR(std::abs(p.symmetry[0].normal.x), 1, 1e-12);
  EXPECT_NEAR(std::abs(p.symmetry[1].normal.y), 1, 1e-12);
  for (const SymmetryPlane& plane : p.symmetry) EXPECT_NEAR(norm(plane.point - Vec3{2, 1, 0}), 0, 1e-12);
  EXPECT_TRUE(prepare_problem(symmetric_problem(symmetric_plate(), 0.2, {})).symmetry.empty());
}

TEST(Symmetry, TheLeastSizeOfAllImagesCounts) {
  const PlanarModel model = named_rectangle();
  const SymmetrySpec one{{{{2, 1, 0}, {1, 0, 0}}}}, two{{{{2, 1, 0}, {1, 0, 0}}, {{2, 1, 0}, {0, 1, 0}}}};
  const auto meshed = [&](const std::vector<std::string>& names, const SymmetrySpec& spec) {
    MeshProblem problem = symmetric_problem(model, 0.2, spec);
    for (const std::string& name : names) problem.size.named.push_back({.name = name, .size = 0.05});
    return mesh(problem, "DBCO").mesh;
  };
  for (const SymmetrySpec& spec : {one, two}) {
    const Mesh both = meshed({"left", "right"}, spec);
    const auto n = static_cast<double>(both.quads.size());
    EXPECT_GT(n, 1.5 * static_cast<double>(meshed({}, spec).quads.size()));
    EXPECT_NEAR(static_cast<double>(meshed({"right"}, spec).quads.size()), n, 0.03 * n);
    EXPECT_NEAR(static_cast<double>(meshed({"left"}, spec).quads.size()), n, 0.03 * n);
    expect_mirrored(both, about_x2);
  }
  std::vector<double> counts;
  for (const double x : {0.5, 3.5})
    for (const double y : {0.25, 1.75}) {
      MeshProblem problem = symmetric_problem(model, 0.2, two);
      const Vec3 at{x, y, 0};
      problem.size.sources = {{at, at, 0.02, 0.2, 0.1, 0.5}};
      counts.push_back(static_cast<double>(mesh(problem, "DBCO").mesh.quads.size()));
    }
  const auto [least, most] = std::ranges::minmax(counts);
  EXPECT_LT(most, 1.1 * least);
  EXPECT_GT(least, 2 * static_cast<double>(meshed({}, two).quads.size()));
}

TEST(Symmetry, PlanesAreFound) {
  const MeshResult r = mesh(symmetric_problem(symmetric_plate(), 0.1, {{}, true}), "DBCO");
  expect_mirrored(r.mesh, about_x2);
  expect_mirrored(r.mesh, about_y1);
  // A triangle with two equal sides has one, a scalene one none.
  const MeshResult t =
      mesh(symmetric_problem(polygons({{{-1, 0}, {1, 0}, {0, 3}}}), 0.2, {{}, true}), "DBCO");
  expect_mirrored(t.mesh, [](Vec3 x) { return Vec3{-x.x, x.y, x.z}; });
  expect_no_plane(polygons({{{-1, 0}, {1.5, 0}, {0, 3}}}));
}

TEST(Symmetry, AxesAreNoCurvesUnlessTheModelHasThem) {
  PlanarModel model = symmetric_plate();
  const SymmetrySpec spec{{{{2, 0, 0}, {1, 0, 0}}}};
  const MeshResult plain = mesh(symmetric_problem(model, 0.11, spec), "DBCO");
  for (const auto& line : plain.mesh.lines)
    EXPECT_FALSE(plain.mesh.points[line[0]].x == 2 && plain.mesh.points[line[1]].x == 2);
  model.curves.push_back({make_segment({2, 0}, {2, 0.65}), "rib", {}});
  const MeshResult ribbed = mesh(symmetric_problem(model, 0.11, spec), "DBCO");
  int on_rib = 0;
  for (std::size_t l = 0; l < ribbed.mesh.lines.size(); ++l)
    on_rib += ribbed.mesh.curves[ribbed.mesh.line_curve[l]].names == std::vector<std::string>{"rib"};
  EXPECT_GE(on_rib, 5);
  expect_mirrored(ribbed.mesh, about_x2);
}

TEST(Symmetry, CracksMayCrossRegionsAndThePlane) {
  PlanarModel model = symmetric_plate();
  model.curves.push_back({make_segment({1.4, 0.9}, {2.6, 0.9}), "crack", {}, true});
  const MeshResult r = mesh(symmetric_problem(model, 0.11, {{{{2, 0, 0}, {1, 0, 0}}}}), "DBCO");
  EXPECT_TRUE(r.soundness.sound()) << r.soundness.text();
  double length = 0;
  for (std::size_t l = 0; l < r.mesh.lines.size(); ++l)
    if (has_name(r.mesh.curves[r.mesh.line_curve[l]], "crack"))
      length += norm(r.mesh.points[r.mesh.lines[l][1]] - r.mesh.points[r.mesh.lines[l][0]]);
  EXPECT_NEAR(length, 2 * 1.2, 1e-9);  // both lips
  expect_mirrored(r.mesh, about_x2);
}

TEST(Symmetry, SeedsKeepMeshesSound) {
  MeshProblem problem = symmetric_problem(symmetric_plate(), 0.11, {{{{2, 0, 0}, {1, 0, 0}}}});
  problem.seed = 5;
  const MeshResult r = mesh(problem, "DBCO");
  EXPECT_TRUE(r.soundness.sound());
  EXPECT_TRUE(r.mesh.triangles.empty());
}

TEST(Symmetry, ModelsThatAreNotSymmetricAreRefused) {
  const auto refused = [](PlanarModel model, SymmetrySpec spec, std::initializer_list<const char*> says) {
    spec.where = "s 1";
    expect_input_error([&] { mesh(symmetric_problem(std::move(model), 0.2, spec), "DBCO"); }, says);
  };
  refused(symmetric_plate(), {{{{1.9, 0, 0}, {1, 0, 0}}}},
          {"s 1: the model is not symmetric", "the mirror image of"});
  PlanarModel hole = polygons({{{0, 0}, {4, 0}, {4, 2}, {0, 2}}, {{1, 0.5}, {1.5, 0.5}, {1.5, 1}}});
  refused(hole, {{{{2, 0, 0}, {1, 0, 0}}}}, {"s 1: the model is not symmetric"});
  refused(symmetric_plate(), {{{{2, 0, 0}, {1, 0, 0}}, {{2, 0, 0}, {1, 1, 0}}}},
          {"s 1: expected one plane", "perpendicular"});
}

TEST(Symmetry, NumbersOfEdgesThatWouldDoAreTold) {
  PlanarModel model = polygons({{{0, 0}, {4, 0}, {4, 2}, {0, 2}}});
  model.loops[0].region = "plate";
  model.curves.push_back({make_circle({2, 1}, 0.5), "hole", {}});
  model.loops.push_back({{static_cast<int>(model.curves.size()) - 1}, "", {}});
  MeshProblem problem =
      symmetric_problem(model, 0.1, {{{{2, 1, 0}, {1, 0, 0}}, {{2, 1, 0}, {0, 1, 0}}}, false, "s 1"});
  for (const int edges : {41, 42}) {
    problem.divisions = {{"hole", edges, 1, 1, "d 1"}};
    expect_input_error([&] { mesh(problem, "DBCO"); },
                       {("d 1: " + std::to_string(edges) + " edges for 'hole'").c_str(), "4 equal parts",
                        "expected 40 or 44"});
  }
  problem.divisions = {{"hole", 44}};
  const MeshResult r = mesh(problem, "DBCO");
  EXPECT_TRUE(r.soundness.sound());
  const auto is_on_hole = [&](int curve) { return has_name(r.mesh.curves[curve], "hole"); };
  EXPECT_EQ(std::ranges::count_if(r.mesh.line_curve, is_on_hole), 44);
  expect_mirrored(r.mesh, about_x2);
}

TEST(Symmetry, DividedCurvesMayHaveShortEdgesAtTheirEnds) {
  const PlanarModel model = named_rectangle();
  for (const double normal : {-1.0, 1.0}) {
    MeshProblem problem = symmetric_problem(model, 0.3, {{{{2, 0, 0}, {normal, 0, 0}}}});
    problem.divisions = {{"below", 12, 1, 0.2}};
    const MeshResult r = mesh(problem, "DBCO");
    std::vector<double> lengths;
    for (std::size_t l = 0; l < r.mesh.lines.size(); ++l)
      if (has_name(r.mesh.curves[r.mesh.line_curve[l]], "below"))
        lengths.push_back(norm(r.mesh.points[r.mesh.lines[l][1]] - r.mesh.points[r.mesh.lines[l][0]]));
    ASSERT_EQ(lengths.size(), 12u);
    const auto [least, most] = std::ranges::minmax(lengths);
    EXPECT_NEAR(least / most, std::pow(0.2, 10.0 / 11), 1e-9);  // of the two edges in the middle, 1 / 11 off
    for (const double x : {0.0, 4.0})
      EXPECT_TRUE(std::ranges::any_of(r.mesh.points, [&](const Vec3& p) {
        return p.y == 0 && std::abs(std::abs(p.x - x) - least) < 1e-9;
      }));
    expect_mirrored(r.mesh, about_x2);
  }
}

TEST(Symmetry, CurvedElementsAreMirroredAndOnTheirCurves) {
  for (const int order : {2, 3}) {
    MeshProblem problem = symmetric_problem(symmetric_plate(), 0.2, {{}, true});
    problem.order = order;
    const MeshResult r = mesh(problem, "DBCO");
    EXPECT_TRUE(r.soundness.sound()) << r.soundness.text();
    EXPECT_EQ(r.mesh.order, order);
    expect_mirrored(r.mesh, about_x2);
    expect_mirrored(r.mesh, about_y1);
    const Mesh& m = r.mesh;
    const std::size_t inside = order - 1;
    ASSERT_EQ(m.line_nodes.size(), inside * m.lines.size());
    std::size_t on_holes = 0;
    for (std::size_t l = 0; l < m.lines.size(); ++l) {
      const Entity& curve = m.curves[m.line_curve[l]];
      for (std::size_t k = 0; has_name(curve, "hole") && k < inside; ++k, ++on_holes) {
        const Vec3& x = m.points[m.line_nodes[inside * l + k]];
        const double middle = 0.8 + 1.2 * std::round((x.x - 0.8) / 1.2);
        EXPECT_NEAR(std::hypot(x.x - middle, x.y - 1), 0.35, 1e-9);
      }
    }
    EXPECT_GT(on_holes, 30u);
  }
}

TEST(Symmetry, CrossesOfThePlaneAreFollowed) {
  MeshProblem problem =
      symmetric_problem(polygons({{{0, 0}, {4, 0}, {4, 2}, {0, 2}}}), 0.1, {{{{2, 0, 0}, {1, 0, 0}}}});
  problem.cross.kind = CrossKind::kField;
  problem.cross.field = make_function_cross([](Vec2 x) { return 0.3 * (x.x - 2); }, "theta");
  const MeshResult r = mesh(problem, "DB");
  double off = 0, sides = 0;
  for (const auto& quad : r.mesh.quads)
    for (int k = 0; k < 4; ++k) {
      const Vec3 a = r.mesh.points[quad[k]], b = r.mesh.points[quad[(k + 1) % 4]], middle = 0.5 * (a + b);
      if (middle.x < 2) continue;
      const double turn = std::atan2(b.y - a.y, b.x - a.x) - 0.3 * (middle.x - 2);
      off += std::abs(std::remainder(turn, std::numbers::pi / 2));
      ++sides;
    }
  EXPECT_LT(off / sides, 0.15);  // along the boundary it would be 0.3
  expect_mirrored(r.mesh, about_x2);
  problem.cross = {.kind = CrossKind::kGradient};
  problem.size.field = nullptr;
  problem.size.function = [](std::span<const Vec3> x, std::span<double> size) {
    for (std::size_t i = 0; i < x.size(); ++i) size[i] = 0.05 + 0.03 * norm(x[i] - Vec3{2, -1, 0});
  };
  const MeshResult radial = mesh(problem, "DB");
  EXPECT_TRUE(radial.soundness.sound());
  expect_mirrored(radial.mesh, about_x2);
}

TEST(Symmetry, GridsAroundHolesAreRefusedForTheHoles) {
  MeshProblem problem = symmetric_problem(symmetric_plate(), 0.1, {{{{2, 0, 0}, {1, 0, 0}}}});
  problem.mapped = {{"plate"}, false, "m 1"};
  expect_input_error([&] { mesh(problem, "DBCO"); },
                     {"'plate' cannot be a grid: something lies inside of it: expected one outline"});
}

TEST(Symmetry, CracksHaveCracksAsImages) {
  const SymmetrySpec spec{{{{1, 0, 0}, {1, 0, 0}}}};
  PlanarModel model = polygons({{{0, 0}, {2, 0}, {2, 1}, {0, 1}}});
  model.curves.push_back({make_segment({0.4, 0.5}, {0.7, 0.5}), "a", {}, true});
  model.curves.push_back({make_segment({1.3, 0.5}, {1.6, 0.5}), "b", {}});
  expect_refused(symmetric_problem(model, 0.1, spec), "DB", {"'a'", "'b'", "is a crack", "[not-symmetric]"});
  model.curves.back().is_crack = true;
  EXPECT_EQ(lines_named(mesh(symmetric_problem(model, 0.1, spec), "DB").mesh, "b").size(), 6u);
}

TEST(Symmetry, CracksBetweenRegionsAreRefused) {
  PlanarModel model = polygons({{{0, 0}, {2, 0}, {2, 0.5}, {0, 0.5}}, {{0, 0.5}, {2, 0.5}, {2, 1}, {0, 1}}});
  model.curves.push_back({make_segment({0.5, 0.5}, {1.5, 0.5}), "mid", {}, true});
  expect_refused(symmetric_problem(model, 0.1, {{{{1, 0, 0}, {1, 0, 0}}}}), "DB",
                 {"'mid'", "between two regions"});
}

TEST(Symmetry, SmallHolesStayRound) {
  constexpr double kRadius = 0.0005;
  const PlanarModel model = ModelMaker()
                                .loop({make_segment({0, 0}, {2, 0}), make_segment({2, 0}, {2, 1}),
                                       make_segment({2, 1}, {0, 1}), make_segment({0, 1}, {0, 0})})
                                .loop({make_circle({0.3, 0.5}, kRadius)})
                                .loop({make_circle({1.7, 0.5}, kRadius)});
  MeshProblem problem = symmetric_problem(model, 0.1, {{{{1, 0, 0}, {1, 0, 0}}}});
  problem.size.named.push_back({.name = "curve_5", .size = 1e-4});
  const Mesh mesh = delquad::mesh(problem, "DBCO").mesh;
  int on_hole = 0;
  for (const Vec3& p : mesh.points) on_hole += std::abs(std::hypot(p.x - 0.3, p.y - 0.5) - kRadius) < 1e-12;
  EXPECT_GE(on_hole, 24);
}

}  // namespace
}  // namespace delquad
