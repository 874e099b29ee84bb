// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "delquad/mesher.h"
#include "features/symmetry/mirror_match.h"
#include "geometry/surface/triangulated_model.h"
#include "mesher/prepare.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/surfaces.h"
#include "tests/support/triangulated_shapes.h"

namespace delquad {
namespace {

MeshProblem problem_of(Mesh triangles, double size, SymmetrySpec spec = {}) {
  MeshProblem problem;
  problem.model = TriangleModel{std::move(triangles)};
  problem.size.field = make_constant_size(size);
  problem.symmetry = std::move(spec);
  return problem;
}

SymmetrySpec at(std::vector<SymmetryPlane> planes) { return {std::move(planes), false, "s 1"}; }

Vec3 mirrored(const SymmetryPlane& plane, const Vec3& x) {
  const Vec3 n = (1 / norm(plane.normal)) * plane.normal;
  return x - (2 * dot(n, x - plane.point)) * n;
}

template <std::size_t N>
std::vector<std::pair<int, Vec3>> middles(const Mesh& mesh, const std::vector<std::array<int, N>>& elements,
                                          const std::vector<int>& of) {
  std::vector<std::pair<int, Vec3>> all;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    Vec3 sum;
    for (const int v : elements[e]) sum = sum + (1.0 / N) * mesh.points[v];
    all.emplace_back(of[e], sum);
  }
  return all;
}

/// How many of `all` have no image, or more than one.
int without_image(
    const SymmetryPlane& plane, std::vector<std::pair<int, Vec3>> all,
    const std::function<int(int)>& image_of = [](int i) { return i; }) {
  constexpr double kSame = 1e-11;
  std::ranges::sort(all, {}, [](const auto& p) { return p.second.x; });
  int bad = 0;
  for (const auto& [of, x] : all) {
    const Vec3 image = mirrored(plane, x);
    int found = 0;
    for (auto p =
             std::ranges::lower_bound(all, image.x - kSame, {}, [](const auto& q) { return q.second.x; });
         p != all.end() && p->second.x <= image.x + kSame; ++p)
      found += norm(p->second - image) <= kSame && (image_of(of) < 0 || p->first == image_of(of));
    bad += found != 1;
  }
  return bad;
}

/// Every node, quad and line has one mirror image; `face`, `curve`: which faces' and curves' (negative: any).
void expect_mirrored(const Mesh& mesh, const SymmetryPlane& plane, const std::function<int(int)>& face = {},
                     const std::function<int(int)>& curve = {}) {
  std::vector<std::pair<int, Vec3>> points;
  for (const Vec3& x : mesh.points) points.emplace_back(0, x);
  const auto any = [](int) { return -1; };
  EXPECT_EQ(without_image(plane, points), 0);
  EXPECT_EQ(without_image(plane, middles(mesh, mesh.quads, mesh.quad_region),
                          face ? face : std::function<int(int)>(any)),
            0);
  EXPECT_EQ(without_image(plane, middles(mesh, mesh.lines, mesh.line_curve),
                          curve ? curve : std::function<int(int)>(any)),
            0);
  const Vec3 n = (1 / norm(plane.normal)) * plane.normal;
  for (const auto& quad : mesh.quads) {
    double low = 0, high = 0;
    for (const int v : quad) {
      low = std::min(low, dot(n, mesh.points[v] - plane.point));
      high = std::max(high, dot(n, mesh.points[v] - plane.point));
    }
    EXPECT_TRUE(low > -1e-11 || high < 1e-11) << "a quad lies across";
  }
}

std::set<int> tags_of(const std::vector<Entity>& entities, const std::vector<int>& used) {
  std::set<int> tags;
  for (const int e : used) tags.insert(entities[e].tag);
  return tags;
}

/// Sound, of quads, and with the topology, faces and curves that it has without planes.
MeshResult expect_as_without(const MeshProblem& problem) {
  const MeshResult with = mesh(problem, "DBCO");
  MeshProblem plain = problem;
  plain.symmetry = {};
  const MeshResult without = mesh(plain, "DBCO");
  EXPECT_TRUE(with.soundness.sound()) << with.soundness.text();
  EXPECT_TRUE(with.mesh.triangles.empty());
  EXPECT_EQ(with.surface->mesh.euler_characteristic, without.surface->mesh.euler_characteristic);
  EXPECT_EQ(with.surface->mesh.free_edges > 0, without.surface->mesh.free_edges > 0);
  EXPECT_EQ(tags_of(with.mesh.regions, with.mesh.quad_region),
            tags_of(without.mesh.regions, without.mesh.quad_region));
  EXPECT_EQ(tags_of(with.mesh.curves, with.mesh.line_curve),
            tags_of(without.mesh.curves, without.mesh.line_curve));
  EXPECT_GT(with.metrics.values.at("eta_mean"), without.metrics.values.at("eta_mean") - 0.02);
  EXPECT_NEAR(static_cast<double>(with.mesh.quads.size()), static_cast<double>(without.mesh.quads.size()),
              0.25 * static_cast<double>(without.mesh.quads.size()));
  return with;
}

const SymmetryPlane kMiddleX{{0.5, 0, 0}, {2, 0, 0}}, kMiddleY{{0, 0.4, 0}, {0, -1, 0}},
    kMiddleZ{{0, 0, 0.35}, {0, 0, 1}};

/// Planes go through triangles of some, along edges of others.
Mesh block(int n) { return testing_support::box(n, 1, 0.8, 0.7); }

TEST(SymmetricSurfaces, BoxesAreMirroredAtUpToThreePlanes) {
  for (const int n : {4, 5}) {
    const MeshResult one = expect_as_without(problem_of(block(n), 0.11, at({kMiddleX})));
    // Faces 1 and 2 are images of each other, the others of themselves.
    expect_mirrored(one.mesh, kMiddleX, [](int f) { return f < 2 ? 1 - f : f; });
    const MeshResult two = expect_as_without(problem_of(block(n), 0.11, at({kMiddleX, kMiddleY})));
    expect_mirrored(two.mesh, kMiddleX, [](int f) { return f < 2 ? 1 - f : f; });
    expect_mirrored(two.mesh, kMiddleY, [](int f) { return f / 2 == 1 ? 5 - f : f; });
  }
  const MeshResult three = expect_as_without(problem_of(block(5), 0.11, at({kMiddleX, kMiddleY, kMiddleZ})));
  for (const SymmetryPlane& plane : {kMiddleX, kMiddleY, kMiddleZ}) expect_mirrored(three.mesh, plane);
}

TEST(SymmetricSurfaces, CurvesThroughAPlaneStayOne) {
  const MeshResult r = mesh(problem_of(block(5), 0.11, at({kMiddleX})), "DBCO");
  std::map<int, int> through;  // lines of each curve at the plane
  for (std::size_t l = 0; l < r.mesh.lines.size(); ++l)
    for (const int v : r.mesh.lines[l]) through[r.mesh.line_curve[l]] += r.mesh.points[v].x == 0.5;
  int curves = 0;
  for (const auto& [curve, ends] : through) {
    EXPECT_TRUE(ends == 0 || ends == 2);
    curves += ends == 2;
  }
  EXPECT_EQ(curves, 4);
}

TEST(SymmetricSurfaces, PlanesMayBeOblique) {
  const double c = std::cos(0.7), s = std::sin(0.7);
  Mesh turned = block(5);
  for (Vec3& x : turned.points) x = {3 + c * x.x - s * x.y, c * x.y + s * x.x, x.z - 2};
  const SymmetryPlane plane{{3 + c * 0.5, s * 0.5, 0}, {c, s, 0}};
  expect_mirrored(expect_as_without(problem_of(turned, 0.11, at({plane}))).mesh, plane);
}

TEST(SymmetricSurfaces, ClosedSurfacesAreCutOpen) {
  const Mesh sphere = testing_support::round_sphere(9).fine;
  const SymmetryPlane x{{0, 0, 0}, {1, 0, 0}}, y{{0, 0, 0}, {0, 1, 0}}, z{{0, 0, 0}, {0, 0, 1}};
  for (const auto& planes : {std::vector{x}, std::vector{y, z}, std::vector{x, y, z}}) {
    const MeshResult r = mesh(problem_of(sphere, 0.2, at(planes)), "DBCO");
    EXPECT_TRUE(r.soundness.sound()) << r.soundness.text();
    EXPECT_EQ(r.surface->mesh.euler_characteristic, 2);
    EXPECT_TRUE(r.surface->mesh.watertight());
    for (const SymmetryPlane& plane : planes) expect_mirrored(r.mesh, plane);
    EXPECT_EQ(r.mesh.regions.size(), 1u);
  }
  const Mesh torus = testing_support::torus(40, 18, 1, 0.4).fine;
  for (const auto& planes : {std::vector{x}, std::vector{z}, std::vector{x, y}, std::vector{x, z}}) {
    const MeshResult r = mesh(problem_of(torus, 0.15, at(planes)), "DBCO");
    EXPECT_TRUE(r.soundness.sound()) << r.soundness.text();
    EXPECT_EQ(r.surface->mesh.euler_characteristic, 0);
    EXPECT_TRUE(r.surface->mesh.watertight());
    for (const SymmetryPlane& plane : planes) expect_mirrored(r.mesh, plane);
  }
}

TEST(SymmetricSurfaces, PlanesAreFound) {
  MeshProblem problem = problem_of(block(5), 0.13, {{}, true});
  const MeshResult box = expect_as_without(problem);
  for (const SymmetryPlane& plane : {kMiddleX, kMiddleY, kMiddleZ}) expect_mirrored(box.mesh, plane);
  // Turned and shifted, with equal sides: the moments do not tell the axes.
  Mesh cube = testing_support::box(4);
  const double c = std::cos(0.4), s = std::sin(0.4);
  for (Vec3& x : cube.points) x = {c * x.x - s * x.y + 0.3, c * x.y + s * x.x, x.z};
  const MeshResult turned = mesh(problem_of(cube, 0.17, {{}, true}), "DBCO");
  const Vec3 centre{c * 0.5 - s * 0.5 + 0.3, c * 0.5 + s * 0.5, 0.5};
  expect_mirrored(turned.mesh, {centre, {0, 0, 1}});
}

/// A block with a corner cut off nowhere: its top slants two ways.
Mesh crooked() {
  Mesh mesh = block(5);
  for (Vec3& x : mesh.points)
    x = {x.x * (1 + 0.2 * x.z), x.y * (1 + 0.3 * x.x), x.z * (1 + 0.3 * x.x + 0.2 * x.y)};
  return mesh;
}

TEST(SymmetricSurfaces, WhereNoPlaneIsFoundAllIsMeshed) {
  const MeshResult r = mesh(problem_of(crooked(), 0.15, {{}, true, "s 1"}), "DBCO");
  EXPECT_TRUE(r.soundness.sound());
  EXPECT_TRUE(std::ranges::any_of(r.warnings, [](const Warning& w) {
    return w.text.find("s 1: no plane of symmetry was found") != std::string::npos;
  }));
  MeshProblem plain = problem_of(crooked(), 0.15);
  EXPECT_EQ(mesh(plain, "DBCO").mesh.points, r.mesh.points);
}

TEST(SymmetricSurfaces, ModelsThatAreNotSymmetricAreRefused) {
  const auto refused = [](Mesh triangles, SymmetrySpec spec, std::initializer_list<const char*> says) {
    expect_input_error([&] { mesh(problem_of(std::move(triangles), 0.2, std::move(spec)), "DBCO"); }, says);
  };
  refused(block(4), at({{{0.6, 0, 0}, {1, 0, 0}}}),
          {"s 1: the model is not symmetric at the plane through (0.6, 0, 0)", "the mirror image of face",
           "is 0.2 away from the model"});
  refused(block(4), at({{{0.5, 0, 0}, {1, 0, 0}}, {{0.5, 0, 0}, {1, 1, 0}}}),
          {"s 1: expected one plane of symmetry, or two or three that are perpendicular"});
  MeshProblem flat = problem_of(block(4), 0.2, at({{{0.5, 0, 0}, {0, 0, 0}}}));
  expect_input_error([&] { mesh(flat, "DBCO"); }, {"s 1: 'planes.normal' has no length"});
  MeshProblem periodic = problem_of(block(4), 0.2, at({kMiddleX}));
  periodic.periodic = {{"curve_1", "curve_2", {}}};
  expect_input_error([&] { mesh(periodic, "DBCO"); }, {"s 1: symmetry does not go with periodic sides"});
}

/// A plate at z = 0, region 1, with a wall that goes up and one that goes down along its side x = 1.
Mesh plate_with_fin() {
  testing_support::TriangulatedShape shape;
  constexpr int n = 6;
  const auto square = [&](const std::function<Vec3(double, double)>& at) {
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const auto p = [&](int a, int b) { return at(double(i + a) / n, double(j + b) / n); };
        shape.triangle(p(0, 0), p(1, 0), p(1, 1));
        shape.triangle(p(0, 0), p(1, 1), p(0, 1));
      }
  };
  shape.region();
  square([](double u, double v) { return Vec3{u, v, 0}; });
  shape.region();
  square([](double u, double v) { return Vec3{1, v, u}; });
  shape.region();
  square([](double u, double v) { return Vec3{1, v, -u}; });
  return shape.mesh;
}

TEST(SymmetricSurfaces, AFaceInThePlaneIsItsOwnImage) {
  const SymmetryPlane z{{0, 0, 0}, {0, 0, 1}};
  const MeshResult r = expect_as_without(problem_of(plate_with_fin(), 0.1, at({z})));
  expect_mirrored(r.mesh, z, [](int f) { return f == 0 ? 0 : 3 - f; });
  const auto n_plate = std::ranges::count(r.mesh.quad_region, 0);
  EXPECT_NEAR(static_cast<double>(n_plate), 100, 30);
  const MeshResult y = expect_as_without(problem_of(plate_with_fin(), 0.1, at({{{0, 0.5, 0}, {0, 1, 0}}})));
  expect_mirrored(y.mesh, {{0, 0.5, 0}, {0, 1, 0}});
}

TEST(SymmetricSurfaces, LinesAndPointsInFacesHaveImages) {
  MeshProblem problem = problem_of(block(5), 0.11, at({kMiddleX}));
  problem.surface.embed = {{{{0.2, 0.2, 0.7}, {0.8, 0.2, 0.7}}, "line", ""},
                           {{{0.3, 0.5, 0.7}}, "left", ""},
                           {{{0.7, 0.5, 0.7}}, "right", ""},
                           {{{0.5, 0.65, 0.7}}, "middle", ""}};
  const MeshResult r = mesh(problem, "DBCO");
  EXPECT_TRUE(r.soundness.sound()) << r.soundness.text();
  expect_mirrored(r.mesh, kMiddleX);
  std::map<std::string, Vec3> points;
  for (const NamedPoint& p : r.mesh.named_points) points[p.entity.names.at(0)] = r.mesh.points[p.point];
  ASSERT_EQ(points.size(), 3u);
  EXPECT_NEAR(norm(points["left"] - Vec3{0.3, 0.5, 0.7}), 0, 1e-12);
  EXPECT_NEAR(norm(points["right"] - Vec3{0.7, 0.5, 0.7}), 0, 1e-12);
  EXPECT_NEAR(norm(points["middle"] - Vec3{0.5, 0.65, 0.7}), 0, 1e-12);
  double length = 0;
  for (std::size_t l = 0; l < r.mesh.lines.size(); ++l)
    if (r.mesh.curves[r.mesh.line_curve[l]].names == std::vector<std::string>{"line"})
      length += norm(r.mesh.points[r.mesh.lines[l][1]] - r.mesh.points[r.mesh.lines[l][0]]);
  EXPECT_NEAR(length, 0.6, 1e-9);
}

TEST(SymmetricSurfaces, LinesAndPointsWithoutImagesSpoilPlanes) {
  const std::vector<std::pair<std::vector<Vec3>, const char*>> items{
      {{{0.3, 0.5, 0.7}}, "the point 'item' at (0.3, 0.5, 0.7) has no mirror image at (0.7, 0.5, 0.7)"},
      {{{0.7, 0.5, 0.7}}, "the point 'item' at (0.7, 0.5, 0.7) has no mirror image at (0.3, 0.5, 0.7)"},
      {{{0.2, 0.2, 0.7}, {0.7, 0.3, 0.7}}, "'item' is 0."}};
  for (const auto& [points, says] : items) {
    MeshProblem problem = problem_of(block(5), 0.13, at({kMiddleX}));
    problem.surface.embed = {{points, "item", ""}};
    expect_input_error([&] { mesh(problem, "DBCO"); },
                       {"s 1: the model is not symmetric at the plane through", says});
    problem.symmetry = {{}, true, "s 1"};
    const MeshResult r = mesh(problem, "DBCO");
    EXPECT_TRUE(std::ranges::any_of(r.warnings, [](const Warning& w) {
      return w.text.find("s 1: no plane of symmetry was found: all of the model is meshed; the plane") == 0 &&
             w.text.find("would be one, but") != std::string::npos &&
             w.text.find("'item'") != std::string::npos;
    }));
    problem.symmetry = {};
    EXPECT_EQ(mesh(problem, "DBCO").mesh.points, r.mesh.points);
  }
  // A point in the middle of a side leaves two planes.
  MeshProblem problem = problem_of(block(5), 0.13, {{}, true, "s 1"});
  problem.surface.embed = {{{{0.5, 0.4, 0.7}}, "item", ""}};
  const MeshingSetup p = prepare_problem(problem);
  EXPECT_EQ(p.symmetry.size(), 2u);
  EXPECT_TRUE(std::ranges::any_of(p.warnings, [](const Warning& w) {
    return w.text.find(
               "s 1: the plane through (0.5, 0.4, 0.35) with the normal (0, 0, 1) would be one, but the "
               "point 'item'") == 0;
  }));
}

/// A strip of length 20 and width 0.0004 at x = 0, `end` at x = 20.
MirrorMatch match_of_strip(double end) {
  constexpr int n = 400;
  Mesh strip;
  for (int i = 0; i <= n; ++i) {
    const double x = 20.0 * i / n, w = 0.0004 + (end - 0.0004) * i / n;
    strip.points.push_back({x, -w / 2, 0});
    strip.points.push_back({x, w / 2, 0});
  }
  for (int i = 0; i < n; ++i) {
    strip.triangles.push_back({2 * i, 2 * i + 2, 2 * i + 3});
    strip.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 1});
  }
  strip.triangle_region.assign(strip.triangles.size(), 0);
  strip.regions = {{1, {}}};
  const SurfaceModel model = make_surface_model(std::move(strip));
  return MirrorMatcher(model).match(SymmetryPlanes(std::vector<SymmetryPlane>{{{10, 0, 0}, {1, 0, 0}}}), 0);
}

TEST(SymmetricSurfaces, OnSliversTheToleranceIsAPartOfTheirWidth) {
  EXPECT_EQ(match_of_strip(0.0004).failure, "");
  EXPECT_NE(match_of_strip(0.0002).failure, "");
}

TEST(SymmetricSurfaces, TheMostCurvatureOfAllImagesCounts) {
  Mesh torus = testing_support::torus(40, 18, 1, 0.4).fine;
  torus.lines.clear();
  torus.line_curve.clear();
  torus.curves.clear();
  torus.regions = {{1, {}}, {2, {}}};
  for (std::size_t t = 0; t < torus.triangles.size(); ++t) {
    const auto& [a, b, c] = torus.triangles[t];
    torus.triangle_region[t] = torus.points[a].x + torus.points[b].x + torus.points[c].x < 0;
  }
  std::vector<std::size_t> counts;
  for (const char* name : {"region_1", "region_2", ""}) {
    MeshProblem problem = problem_of(torus, 0.2, at({{{0, 0, 0}, {1, 0, 0}}}));
    if (*name != 0) problem.size.named = {{.name = name, .curvature = 40}};
    counts.push_back(mesh(problem, "DBCO").mesh.quads.size());
  }
  EXPECT_EQ(counts[0], counts[1]);
  EXPECT_GT(counts[0], 2 * counts[2]);
}

TEST(SymmetricSurfaces, TheLeastSizeOfAllImagesCounts) {
  MeshProblem problem = problem_of(block(5), 0.1, at({kMiddleX}));
  problem.size.field = nullptr;
  problem.size.function = [](std::span<const Vec3> x, std::span<double> size) {
    for (std::size_t i = 0; i < x.size(); ++i) size[i] = x[i].x > 0.5 ? 0.05 : 0.2;
  };
  const MeshResult before = mesh(problem, "DBCO");
  problem.symmetry.planes[0].normal = {-1, 0, 0};
  const MeshResult behind = mesh(problem, "DBCO");
  expect_mirrored(before.mesh, kMiddleX);
  expect_mirrored(behind.mesh, kMiddleX);
  const double n = static_cast<double>(before.mesh.quads.size());
  EXPECT_NEAR(static_cast<double>(behind.mesh.quads.size()), n, 0.1 * n);
  EXPECT_GT(n, 0.8 * 2 * (0.8 + 0.7 + 0.8 * 0.7) / (0.05 * 0.05));
  // Faces by name: what both sides ask for is what one of them does.
  const auto quads = [](const std::vector<std::string>& names) {
    MeshProblem named = problem_of(block(5), 0.2, at({kMiddleX}));
    for (const std::string& name : names) named.size.named.push_back({.name = name, .size = 0.05});
    return static_cast<double>(mesh(named, "DBCO").mesh.quads.size());
  };
  const double both = quads({"region_1", "region_2"});
  EXPECT_NEAR(quads({"region_1"}), both, 0.03 * both);
  EXPECT_NEAR(quads({"region_2"}), both, 0.03 * both);
  EXPECT_GT(both, 2 * quads({}));
}

TEST(SymmetricSurfaces, PlanesThatAreFoundAreTold) {
  const MeshingSetup p = prepare_problem(problem_of(block(5), 0.2, {{}, true}));
  ASSERT_EQ(p.symmetry.size(), 3u);
  for (const SymmetryPlane& plane : p.symmetry)
    EXPECT_NEAR(dot(Vec3{0.5, 0.4, 0.35} - plane.point, plane.normal), 0, 1e-9);
}

TEST(SymmetricSurfaces, DividedCurvesShareTheirEdges) {
  MeshProblem problem = problem_of(block(5), 0.11, at({kMiddleX}));
  // A curve that goes through the plane.
  const MeshResult before = mesh(problem, "DBCO");
  std::string name;
  for (std::size_t l = 0; l < before.mesh.lines.size() && name.empty(); ++l)
    for (const int v : before.mesh.lines[l])
      if (before.mesh.points[v].x == 0.5)
        name = "curve_" + std::to_string(before.mesh.curves[before.mesh.line_curve[l]].tag);
  problem.divisions = {{name, 14, 1, 1, "d 1"}};
  const MeshResult r = mesh(problem, "DBCO");
  int edges = 0;
  for (const int c : r.mesh.line_curve) edges += "curve_" + std::to_string(r.mesh.curves[c].tag) == name;
  EXPECT_EQ(edges, 14);
  expect_mirrored(r.mesh, kMiddleX);
  problem.divisions[0].edges = 13;
  expect_input_error([&] { mesh(problem, "DBCO"); }, {"d 1: 13 edges for curve", "expected 12 or 14"});
  problem.divisions[0].edges = 14;
  problem.divisions[0].progression = 1.2;
  expect_input_error([&] { mesh(problem, "DBCO"); }, {"d 1: curve", "expected edges of equal length"});
}

TEST(SymmetricSurfaces, CurvedElementsAreMirrored) {
  MeshProblem problem = problem_of(testing_support::round_sphere(24).fine, 0.3, {{}, true});
  problem.order = 2;
  const MeshResult faceted = mesh(problem, "DBCO");
  EXPECT_TRUE(faceted.soundness.sound()) << faceted.soundness.text();
  EXPECT_EQ(faceted.mesh.order, 2);
  for (const SymmetryPlane& plane : faceted.prepared->symmetry) expect_mirrored(faceted.mesh, plane);
  problem.model = ExampleModel{"torus"};
  problem.size.field = make_constant_size(5);
  problem.symmetry = at({{{0, 0, 0}, {0, 0, 1}}});
  const MeshResult torus = mesh(problem, "DBCO");
  EXPECT_TRUE(torus.soundness.sound()) << torus.soundness.text();
  expect_mirrored(torus.mesh, problem.symmetry.planes[0]);
}

TEST(SymmetricSurfaces, ExamplesOfCadAreMirrored) {
  const std::vector<std::pair<std::string, SymmetryPlane>> examples{{"bracket", {{0, 30, 0}, {0, 1, 0}}},
                                                                    {"torus", {{0, 0, 0}, {0, 0, 1}}},
                                                                    {"elbow", {{0, 0, 0}, {0, 0, 1}}}};
  for (const auto& [name, plane] : examples) {
    MeshProblem problem;
    problem.model = ExampleModel{name};
    problem.size.field = make_constant_size(5);
    problem.symmetry = {{}, true, "s 1"};
    MeshResult r;
    try {
      r = mesh(problem, "DBCO");
    } catch (const InputError& error) {
      if (std::string(error.what()).find("OpenCASCADE") != std::string::npos) GTEST_SKIP() << error.what();
      throw;
    }
    EXPECT_TRUE(r.soundness.sound()) << name << ": " << r.soundness.text();
    expect_mirrored(r.mesh, plane);
  }
}

}  // namespace
}  // namespace delquad
