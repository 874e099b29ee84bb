// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/orientation.h"
#include "features/extrusion/layers.h"
#include "geometry/mesh/find_crossings.h"
#include "io/mesh_io.h"
#include "metrics/cells.h"
#include "tests/features/extrusion/hex_checks.h"

namespace delquad::testing_support {
namespace {

/// [0, 4] x [0, 2], left half "steel", right half without a name; the line between is "weld"; a point
/// "sensor".
Mesh two_regions() {
  Mesh mesh = quad_grid(4, 2, 4, 2);
  mesh.regions = {{3, {"steel", "metal"}}, {7, {}}};
  for (std::size_t q = 0; q < mesh.quads.size(); ++q) mesh.quad_region[q] = q % 4 < 2 ? 0 : 1;
  mesh.curves.push_back({9, {"weld"}});
  for (const auto& [a, b] : {std::pair(2, 7), std::pair(7, 12)}) {
    mesh.lines.push_back({a, b});
    mesh.line_curve.push_back(4);
  }
  mesh.curves[3].names.clear();
  mesh.named_points = {{6, {2, {"sensor"}}}};
  mesh.unit = "mm";
  return mesh;
}

TEST(Sections, NamesBecomeThoseOfVolumesFacesAndCurves) {
  ReadNotes notes;
  const Mesh mesh = extrude(two_regions(), AlongVector{{0, 0, 3}}, {3}, &notes);
  expect_sound(mesh);
  EXPECT_TRUE(notes.empty());
  EXPECT_EQ(mesh.unit, "mm");
  ASSERT_EQ(mesh.volumes.size(), 2u);
  EXPECT_EQ(mesh.volumes[0].tag, 3);
  EXPECT_EQ(mesh.volumes[0].names, (std::vector<std::string>{"steel", "metal"}));
  EXPECT_EQ(mesh.volumes[1].tag, 7);
  EXPECT_EQ(mesh.volumes[1].names, std::vector<std::string>{"region_7"});
  EXPECT_EQ(std::ranges::count(mesh.hex_volume, 1), 12);
  EXPECT_EQ(quads_by_name(mesh), (std::map<std::string, int>{{"south", 12},
                                                             {"east", 6},
                                                             {"north", 12},
                                                             {"curve_4", 6},
                                                             {"weld", 6},
                                                             {"steel start", 4},
                                                             {"metal start", 4},
                                                             {"region_7 start", 4},
                                                             {"steel end", 4},
                                                             {"metal end", 4},
                                                             {"region_7 end", 4}}));
  std::set<int> tags;
  for (const Entity& face : mesh.regions) EXPECT_TRUE(tags.insert(face.tag).second);
  ASSERT_EQ(mesh.curves.size(), 1u);
  EXPECT_EQ(mesh.curves[0].names, std::vector<std::string>{"sensor"});
  ASSERT_EQ(mesh.lines.size(), 3u);
  EXPECT_EQ(mesh.points[mesh.lines[2][1]], (Vec3{1, 1, 3}));
  for (std::size_t q = 0; q < mesh.quads.size(); ++q)
    for (const int v : mesh.quads[q]) {
      const std::string& name = mesh.regions[mesh.quad_region[q]].names[0];
      if (name == "weld") {
        EXPECT_EQ(mesh.points[v].x, 2);
      }
      if (name == "steel end") {
        EXPECT_EQ(mesh.points[v].z, 3);
      }
      if (name == "south") {
        EXPECT_EQ(mesh.points[v].y, 0);
      }
    }
}

TEST(Sections, RegionsEndAtTheirHeights) {
  const Mesh mesh = extrude(two_regions(), AlongVector{{0, 0, 3}}, {.number = 3, .heights = {{"metal", 1}}});
  expect_sound(mesh);
  EXPECT_NEAR(measure(mesh).volume, 4 * 1 + 4 * 3, 1e-13);
  EXPECT_EQ(std::ranges::count(mesh.hex_volume, 0), 4);
  EXPECT_EQ(mesh.lines.size(), 1u);  // the sensor, in steel
  std::map<std::string, int> counts = quads_by_name(mesh);
  EXPECT_EQ(counts["weld"], 6);
  EXPECT_EQ(counts["south"], 2 + 6);
  for (std::size_t q = 0; q < mesh.quads.size(); ++q)
    for (const int v : mesh.quads[q])
      if (mesh.regions[mesh.quad_region[q]].names[0] == "steel end") {
        EXPECT_EQ(mesh.points[v].z, 1);
      }
  // A layer ends at each height. Layers in between keep their growth.
  const Mesh graded = extrude(two_regions(), AlongVector{{0, 0, -1}},
                              {.number = 6, .growth = 1.3, .heights = {{"steel", 1.1}, {"region_7", 3}}});
  expect_sound(graded);
  std::set<double> levels;
  for (const Vec3& p : graded.points) levels.insert(-p.z);
  const std::vector<double> at(levels.begin(), levels.end());
  ASSERT_EQ(at.size(), 7u);
  EXPECT_EQ(at.back(), 3);
  EXPECT_EQ(std::ranges::count(at, 1.1), 1);
  EXPECT_NEAR((at[2] - at[1]) / (at[1] - at[0]), 1.3, 1e-12);
  EXPECT_NEAR((at[6] - at[5]) / (at[5] - at[4]), 1.3, 1e-12);
  // Thicknesses of shells.
  const Mesh box = cube_surface(2, [](const Vec3& p) { return p; });
  Mesh sides = box;
  sides.regions.push_back({2, {"thick"}});
  for (std::size_t q = 0; q < 4; ++q) sides.quad_region[q] = 1;
  for (const double sign : {1, -1})
    expect_sound(extrude(sides, AlongNormals{0.1 * sign}, {.number = 2, .heights = {{"thick", 0.2}}}));
  const auto refused = [](const SweepPath& path, const SweepLayers& layers,
                          std::initializer_list<const char*> parts) {
    expect_not_extruded(two_regions(), path, layers, parts);
  };
  const AlongVector up{{0, 0, 3}};
  refused(up, {.number = 3, .heights = {{"stel", 1}}},
          {"no region has the name 'stel'", "did you mean 'steel'"});
  refused(up, {.number = 3, .heights = {{"steel", 0}}}, {"height of 0 for 'steel'"});
  refused(up, {.number = 1, .heights = {{"steel", 1}}}, {"1 layers are too few for 2 heights"});
  refused(AlongNormals{1, true}, {.number = 2, .heights = {{"steel", 1}}}, {"expected none here"});
  refused(AroundAxis{{-1, 0, 0}, {0, 1, 0}, 90}, {.number = 2, .heights = {{"steel", 1}}},
          {"heights go along a vector"});
}

TEST(Sections, QuadsMayRunEitherWayRound) {
  const Mesh plain = two_regions();
  Mesh mixed = plain;
  for (std::size_t q = 0; q < mixed.quads.size(); q += 3) std::swap(mixed.quads[q][0], mixed.quads[q][2]);
  for (const SweepPath& path : {SweepPath(AlongVector{{0, 0, 1}}), SweepPath(AlongVector{{0, 0, -1}})}) {
    const Mesh mesh = extrude(mixed, path, {2});
    expect_sound(mesh);
    EXPECT_NEAR(measure(mesh).volume, 8, 1e-13);
  }
  expect_sound(extrude(mixed, AlongNormals{0.5}, {2}));
}

TEST(Sections, WhatIsNoEdgeOrCornerOfQuadsIsLeftOut) {
  Mesh mesh = two_regions();
  mesh.points.push_back({9, 9, 9});
  mesh.points.push_back({9, 9, 8});
  mesh.lines.push_back({15, 16});
  mesh.line_curve.push_back(0);
  mesh.named_points.push_back({16, {5, {"far"}}});
  ReadNotes notes;
  const Mesh swept = extrude(mesh, AlongVector{{0, 0, 1}}, {1}, &notes);
  expect_sound(swept);
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_EQ(notes[0], "1 lines are no edges of quads and were left out");
  EXPECT_EQ(notes[1], "1 named points are no corners of quads and were left out");
}

TEST(Sections, Refused) {
  const auto up = [](const Mesh& mesh, std::initializer_list<const char*> parts) {
    expect_not_extruded(mesh, AlongVector{{0, 0, 1}}, {2}, parts);
  };
  Mesh mesh = quad_grid(2, 2);
  mesh.triangles = {{0, 1, 2}};
  mesh.triangle_region = {0};
  up(mesh, {"1 triangles beside 4 quads"});
  mesh = quad_grid(2, 2);
  mesh.order = 2;
  up(mesh, {"order 2"});
  up(Mesh{}, {"no quads"});
  mesh = quad_grid(2, 2);
  mesh.quads[0][1] = mesh.quads[0][0];
  up(mesh, {"two corners", "(0, 0, 0)"});
  mesh = quad_grid(2, 2);
  mesh.quads[0][1] = 99;
  up(mesh, {"99"});
  mesh = {};
  for (const int k : {0, 1, 2})
    add_patch(mesh, 1, 1, [&](double s, double t) {
      return Vec3{s * std::cos(2.0 * k), s * std::sin(2.0 * k), t};
    });
  up(mesh, {"3 quads share the edge at (0, 0, 0.5)"});
  mesh = {};
  add_patch(mesh, 12, 1, [](double s, double t) {
    const double a = 2 * kPi * s, r = 3 + (t - 0.5) * std::cos(a / 2);
    return Vec3{r * std::cos(a), r * std::sin(a), (t - 0.5) * std::sin(a / 2)};
  });
  up(mesh, {"one side only"});
  expect_not_extruded(quad_grid(2, 2), AlongVector{{0, 0, 1}}, {0}, {"0 layers"});
  expect_not_extruded(quad_grid(2, 2), AlongVector{}, {1}, {"not all 0"});
  expect_not_extruded(quad_grid(2, 2), AlongVector{{1, 0, 0}}, {1}, {"inverted or flat"});
  expect_not_extruded(quad_grid(2, 2), AlongVector{{0, 0, 1}}, {100, 1, 399}, {"more than 399"});
  expect_not_extruded(quad_grid(2, 2), AlongVector{{1e308, 0, 1.7e308}}, {2}, {"inverted"});
}

TEST(Sections, BodiesThatMeetThemselvesAreRefused) {
  // Two plates that face each other.
  Mesh plates;
  add_patch(plates, 3, 3, [](double s, double t) { return Vec3{s, t, 0}; });
  add_patch(plates, 3, 3, [](double s, double t) { return Vec3{s + 0.1, 0.9 - t, 1}; });
  EXPECT_NO_THROW(extrude(plates, AlongNormals{0.45}, {1}));
  expect_not_extruded(plates, AlongNormals{0.7}, {1}, {"meets itself at"});
  // A curve that goes through itself, at any angle and at right angles.
  const Mesh square = quad_grid(2, 2, 0.2, 0.2);
  for (const double end : {-2.0, -0.95})
    expect_not_extruded(
        square,
        AlongCurve{{{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {2, 0, 2.3}, {2, 0, 1}, {1, 0.01, 1}, {end, 0.01, 1}}},
        {}, {"meets itself at"});
  // Beside itself is well.
  EXPECT_NO_THROW(extrude(
      square, AlongCurve{{{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {2, 0, 2.3}, {2, 0, 1}, {1, 2, 1}, {-2, 2, 1}}},
      {}));
}

/// Nodes of a crack are there twice; both sides lie on each other.
TEST(Sections, CracksStay) {
  Mesh mesh = quad_grid(4, 4);
  mesh.points.push_back(mesh.points[11]);
  for (const std::size_t above : {8u, 9u}) std::ranges::replace(mesh.quads[above], 11, 25);
  for (const SweepPath& path :
       {SweepPath(AlongVector{{0.3, 0.1, 1}}), SweepPath(AroundAxis{{-1, 0, 0}, {0.1, 1, 0}, 200}),
        SweepPath(AlongCurve{{{0, 0, 0}, {0, 0.3, 1}, {0, 1, 2}}})}) {
    const Mesh swept = extrude(mesh, path, {8});
    expect_sound(swept);
  }
}

TEST(Sections, TheSameBytesForEveryNumberOfThreads) {
  const TemporaryFolder folder;
  for (const char* name : {"a.msh", "a.vtu", "a.inp"}) {
    const std::string text = on_threads({1, 1, 4}, [&] {
      write_mesh(folder / name, extrude(sphere(8, 2), AlongNormals{0.3, true}, {3, 1.5}));
      return read_text(folder / name);
    });
    EXPECT_FALSE(text.empty());
  }
  Mesh named = extrude(sphere(8, 2), AlongNormals{0.3, true}, {1});
  named.regions[0].names = {std::string(90, 'x')};
  EXPECT_EQ(renamed_in_file("a.e", named),
            std::vector{"face \"" + std::string(90, 'x') + "\" is " + std::string(70, 'x')});
  EXPECT_TRUE(renamed_in_file("a.vtu", named).empty());
  expect_input_error([&] { write_mesh(folder / "a.obj", named); },
                     {"a.obj", "not written with cells", ".msh, .vtu, .inp, "});
  expect_input_error([&] { write_mesh(folder / "a.what", named); }, {"unknown kind", ".what"});
  expect_input_error([&] { write_mesh(folder / "a.vtu", named, {.binary = true}); },
                     {"--binary is for .msh"});
  expect_input_error([&] { write_mesh(folder / "a.vtu", named, {.element = "C3D8"}); },
                     {"expected .inp with --element"});
  expect_input_error([&] { write_mesh(folder / "a.inp", named, {.element = "C3D21"}); },
                     {"unknown kind of cells", "did you mean"});
}

double random_number(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

/// The Jacobian of the trilinear map by differences of the map itself.
double jacobian_at(const std::array<Vec3, 8>& p, double u, double v, double w) {
  const auto map = [&](double a, double b, double c) {
    const auto mix = [](double t, const Vec3& x, const Vec3& y) { return (1 - t) * x + t * y; };
    return mix(c, mix(b, mix(a, p[0], p[1]), mix(a, p[3], p[2])),
               mix(b, mix(a, p[4], p[5]), mix(a, p[7], p[6])));
  };
  return dot(cross(map(1, v, w) - map(0, v, w), map(u, 1, w) - map(u, 0, w)), map(u, v, 1) - map(u, v, 0));
}

TEST(Hexahedra, AreProvenPositiveWhereSamplesAre) {
  std::mt19937_64 random(7);
  int proven = 0, refuted = 0, between = 0;
  for (int k = 0; k < 1500; ++k) {
    std::array<Vec3, 8> at = {
        {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
    for (Vec3& p : at)
      p = p +
          0.9 * Vec3{random_number(random) - 0.5, random_number(random) - 0.5, random_number(random) - 0.5};
    double least = 1e9;
    constexpr int kSamples = 8;
    for (int i = 0; i <= kSamples; ++i)
      for (int j = 0; j <= kSamples; ++j)
        for (int l = 0; l <= kSamples; ++l)
          least = std::min(least,
                           jacobian_at(at, double(i) / kSamples, double(j) / kSamples, double(l) / kSamples));
    const bool positive = is_positive(at);
    if (positive) {
      EXPECT_GT(least, 0);
    }
    proven += positive;
    refuted += least < 0;
    between += !positive && least >= 0;
  }
  EXPECT_GT(proven, 300);
  EXPECT_GT(refuted, 200);
  EXPECT_LT(between, 10);  // of which samples missed the place
}

TEST(Hexahedra, VolumesAreThoseOfTheMap) {
  // A frustum with side 1 below and s above, turned by no angle: h (1 + s + s^2) / 3.
  for (const double s : {0.0, 0.5, 2.0}) {
    const std::array<Vec3, 8> at = {
        {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 3}, {s, 0, 3}, {s, s, 3}, {0, s, 3}}};
    EXPECT_NEAR(signed_volume(at), 1 + s + s * s, 1e-14);
  }
}

/// Where an edge goes through a triangle, by the volumes of tetrahedra in long double.
bool goes_through(const std::array<Vec3, 3>& s, const std::array<Vec3, 3>& t) {
  const auto volume = [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const Vec3 u = b - a, v = c - a, w = d - a;
    return static_cast<long double>(u.x) * (v.y * w.z - v.z * w.y) -
           static_cast<long double>(u.y) * (v.x * w.z - v.z * w.x) +
           static_cast<long double>(u.z) * (v.x * w.y - v.y * w.x);
  };
  for (int k = 0; k < 3; ++k) {
    const Vec3 &p = s[k], &q = s[(k + 1) % 3];
    if (volume(t[0], t[1], t[2], p) * volume(t[0], t[1], t[2], q) >= 0) continue;
    const long double x = volume(p, q, t[0], t[1]), y = volume(p, q, t[1], t[2]),
                      z = volume(p, q, t[2], t[0]);
    if ((x >= 0 && y >= 0 && z >= 0) || (x <= 0 && y <= 0 && z <= 0)) return true;
  }
  return false;
}

TEST(Crossings, AreThoseOfAllPairs) {
  std::mt19937_64 random(11);
  int crossed = 0;
  for (int k = 0; k < 300; ++k) {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    for (int i = 0; i < 12; ++i) {
      const Vec3 centre{random_number(random), random_number(random), random_number(random)};
      for (int j = 0; j < 3; ++j)
        points.push_back(centre +
                         0.5 * Vec3{random_number(random), random_number(random), random_number(random)});
      triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    int first = -1;
    for (int i = 11; i >= 0; --i)
      for (int j = 0; j < 12; ++j) {
        const auto corners = [&](int t) {
          return std::array{points[3 * t], points[3 * t + 1], points[3 * t + 2]};
        };
        if (i != j && goes_through(corners(i), corners(j))) first = i;
      }
    const auto found = find_crossing(points, triangles);
    EXPECT_EQ(found.has_value(), first >= 0);
    if (found) {
      EXPECT_EQ(found->first, first);
    }
    crossed += first >= 0;
  }
  EXPECT_GT(crossed, 50);
  EXPECT_LT(crossed, 250);
}

TEST(Crossings, OrientationIsExact) {
  EXPECT_EQ(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), 1);
  EXPECT_EQ(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, 0}), 0);
  EXPECT_EQ(orient3d({0, 0, 0.1}, {1, 0, 0.1}, {0, 1, 0.1}, {0.3, 0.3, std::nextafter(0.1, 0)}), -1);
}

}  // namespace
}  // namespace delquad::testing_support
