// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/example_models.h"
#include "io/mesh_io.h"
#include "metrics/shape.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

constexpr double kHalfTurn = std::numbers::pi;

MeshProblem problem_of(Model model, double size, std::vector<PeriodicPair> periodic) {
  MeshProblem problem = problem_of(std::move(model), size);
  problem.periodic = std::move(periodic);
  return problem;
}

const std::vector<PeriodicPair> kCellPairs = {{"region_1", "region_2", {{1, 0, 0}}, "p 1"},
                                              {"region_3", "region_4", {{0, 1, 0}}, "p 2"},
                                              {"region_5", "region_6", {{0, 0, 1}}, "p 3"}};

/// All nodes of an image are images of its master's nodes, to rounding, and so are its quads, one by one.
void expect_images(const Mesh& mesh, std::size_t n_pairs) {
  ASSERT_EQ(mesh.periodic_faces.size(), n_pairs);
  const double rounding = 1e-12 * diagonal(mesh);
  for (const PeriodicFaces& pair : mesh.periodic_faces) {
    std::map<int, int> image;
    for (const auto& [node, of] : pair.nodes) {
      EXPECT_LE(norm(pair.motion(mesh.points[of]) - mesh.points[node]), rounding);
      EXPECT_TRUE(image.emplace(of, node).second);
    }
    std::vector<std::array<int, 4>> images, quads;
    for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
      std::array<int, 4> quad = mesh.quads[q];
      if (mesh.quad_region[q] == pair.face) quads.push_back(quad);
      if (mesh.quad_region[q] != pair.master) continue;
      for (int& v : quad) v = image.at(v);
      if (pair.is_reversed) std::reverse(quad.begin() + 1, quad.end());
      images.push_back(quad);
    }
    EXPECT_FALSE(quads.empty());
    EXPECT_EQ(images, quads);
    std::set<int> nodes, own;
    for (const auto& quad : quads) nodes.insert(quad.begin(), quad.end());
    for (const auto& [of, node] : image) own.insert(node);
    EXPECT_EQ(nodes, own);
  }
  for (const PeriodicNodes& pair : mesh.periodic)
    for (const auto& [node, of] : pair.nodes)
      EXPECT_LE(norm(pair.motion(mesh.points[of]) - mesh.points[node]), rounding);
}

/// The volume of a solid: positive if its quads look outwards.
double volume(const Mesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c, d] : mesh.quads) {
    const auto& p = mesh.points;
    sum += dot(p[a], cross(p[b], p[c])) + dot(p[a], cross(p[c], p[d]));
  }
  return sum / 6;
}

TEST(PeriodicFaces, CubesMatchInThreeDirections) {
  for (const char* word : {"DB", "DBCO", "DLBCO"}) {
    const MeshResult r = mesh(problem_of(TriangleModel{box(3)}, 0.13, kCellPairs), word);
    EXPECT_TRUE(r.mesh.triangles.empty());
    expect_images(r.mesh, 3);
    for (const PeriodicFaces& pair : r.mesh.periodic_faces) EXPECT_TRUE(pair.is_reversed);
    EXPECT_NEAR(volume(r.mesh), 1, 1e-12);
    // Three of four parallel edges are images, each of one.
    EXPECT_EQ(r.mesh.periodic.size(), 9u);
  }
}

TEST(PeriodicFaces, SizesOnTheFirstFaceCount) {
  MeshProblem problem = problem_of(TriangleModel{box(4)}, 0.1, kCellPairs);
  problem.size.field = make_function_size([](const Vec3& x) { return 0.07 + 0.1 * x.x; }, "size");
  const MeshResult fine = mesh(problem, "DBCO");
  expect_images(fine.mesh, 3);
  problem.periodic[0] = {"region_2", "region_1", {{-1, 0, 0}}, "p 1"};
  const MeshResult coarse = mesh(problem, "DBCO");
  expect_images(coarse.mesh, 3);
  const auto quads_on = [](const Mesh& mesh, int tag) {
    return std::ranges::count_if(mesh.quad_region, [&](int f) { return mesh.regions[f].tag == tag; });
  };
  EXPECT_GT(quads_on(fine.mesh, 2), 3 * quads_on(coarse.mesh, 1));
}

/// The unit cube with a hole of radius 0.3 along z. Regions 1 to 6 are as in box(), 7 is the hole.
Mesh cell_with_hole(int n) {
  TriangulatedShape shape;
  const int around = 4 * n;
  const auto rim = [&](int i) {
    const int side = i / n % 4;
    const double t = static_cast<double>(i % n) / n;
    const std::array<Vec3, 4> at{Vec3{0 + t, 0, 0}, Vec3{1, t, 0}, Vec3{1 - t, 1, 0}, Vec3{0, 1 - t, 0}};
    return at[side];
  };
  const auto hole = [&](int i) {
    const double a = 2 * kHalfTurn * (i % around) / around - 0.75 * kHalfTurn;
    return Vec3{0.5 + 0.3 * std::cos(a), 0.5 + 0.3 * std::sin(a), 0};
  };
  const Vec3 up{0, 0, 1};
  const auto quad = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    shape.triangle(a, b, c);
    shape.triangle(a, c, d);
  };
  const std::array<int, 4> side_of_region{3, 1, 0, 2};  // x = 0, x = 1, y = 0, y = 1
  for (const int side : side_of_region) {
    shape.region();
    for (int i = side * n; i < (side + 1) * n; ++i)
      for (int k = 0; k < n; ++k) {
        const Vec3 low = (1.0 * k / n) * up, high = (1.0 * (k + 1) / n) * up;
        quad(rim(i) + low, rim(i + 1) + low, rim(i + 1) + high, rim(i) + high);
      }
  }
  shape.region();
  for (int i = 0; i < around; ++i) quad(rim(i), hole(i), hole(i + 1), rim(i + 1));
  shape.region();
  for (int i = 0; i < around; ++i) quad(rim(i) + up, rim(i + 1) + up, hole(i + 1) + up, hole(i) + up);
  shape.region();
  for (int i = 0; i < around; ++i) {
    shape.triangle(hole(i), hole(i) + up, hole(i + 1));
    shape.triangle(hole(i + 1), hole(i) + up, hole(i + 1) + up);
  }
  return shape.mesh;
}

TEST(PeriodicFaces, HolesThroughFacesMatch) {
  for (const char* word : {"DB", "DBCO", "DLBCO"}) {
    const MeshResult r = mesh(problem_of(TriangleModel{cell_with_hole(8)}, 0.11, kCellPairs), word);
    EXPECT_TRUE(r.mesh.triangles.empty());
    expect_images(r.mesh, 3);
    EXPECT_NEAR(volume(r.mesh), 1 - 0.09 * kHalfTurn, 0.01);
  }
}

/// A solid swept by a polygon of the half-plane y = 0, x >= 0, about z by `angle`. Regions 1 and 2 are the
/// polygon at its first and last place, the others its sides. Sides on the axis sweep nothing.
Mesh swept(const std::vector<Vec2>& polygon, Vec2 middle, double angle, int steps) {
  TriangulatedShape shape;
  const auto at = [&](Vec2 p, int k) {
    const double a = angle * k / steps;
    return Vec3{p.x * std::cos(a), p.x * std::sin(a), p.y};
  };
  const std::size_t n = polygon.size();
  for (const int end : {0, 1}) {
    shape.region();
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 a = at(polygon[i], end * steps), b = at(polygon[(i + 1) % n], end * steps),
                 c = at(middle, end * steps);
      if (end == 0)
        shape.triangle(c, a, b);
      else
        shape.triangle(c, b, a);
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 p = polygon[i], q = polygon[(i + 1) % n];
    if (p.x == 0 && q.x == 0) continue;
    shape.region();
    for (int k = 0; k < steps; ++k) {
      if (p.x > 0) shape.triangle(at(p, k), at(p, k + 1), at(q, k + 1));
      if (q.x > 0) shape.triangle(at(p, k), at(q, k + 1), at(q, k));
    }
  }
  return shape.mesh;
}

TEST(PeriodicFaces, PipesThatBendMatch) {
  std::vector<Vec2> circle;
  for (int i = 0; i < 24; ++i) {
    const double a = 2 * kHalfTurn * i / 24;
    circle.push_back({3 + std::cos(a), std::sin(a)});
  }
  Mesh pipe = swept(circle, {3, 0}, kHalfTurn / 2, 16);
  for (int& region : pipe.triangle_region) region = std::min(region, 2);  // one face around
  pipe.regions.resize(3);
  for (const char* word : {"DB", "DBCO", "DLBCO"}) {
    const MeshResult r = mesh(
        problem_of(TriangleModel{pipe}, 0.3, {{"region_1", "region_2", {{}, kHalfTurn / 2}, "p"}}), word);
    EXPECT_TRUE(r.mesh.triangles.empty());
    expect_images(r.mesh, 1);
    EXPECT_NEAR(volume(r.mesh), kHalfTurn * 3 * kHalfTurn / 2, 0.5);
  }
}

TEST(PeriodicFaces, SectorsTouchTheirAxis) {
  const double angle = kHalfTurn / 5;
  const Mesh wedge = swept({{0, 0}, {1, 0}, {1.4, 0.5}, {1, 1}, {0, 1.2}}, {0.6, 0.5}, angle, 6);
  for (const char* word : {"DB", "DBCO", "DLBCO"}) {
    const MeshResult r =
        mesh(problem_of(TriangleModel{wedge}, 0.12, {{"region_1", "region_2", {{}, angle}, "p"}}), word);
    EXPECT_TRUE(r.mesh.triangles.empty());
    expect_images(r.mesh, 1);
    std::size_t on_axis = 0;
    for (const auto& [node, of] : r.mesh.periodic_faces[0].nodes) {
      const Vec3& x = r.mesh.points[node];
      EXPECT_EQ(node == of, std::hypot(x.x, x.y) < 1e-9);
      on_axis += node == of;
    }
    EXPECT_GT(on_axis, 8u);
    EXPECT_GT(volume(r.mesh), 0);
  }
}

TEST(PeriodicFaces, CurvedFacesMatch) {
  const MeshProblem flat =
      problem_of(TriangleModel{box(16)}, 0.11, {{"region_1", "region_2", {{1, 0, 0}}, "p"}});
  MeshProblem curved = flat;
  for (Vec3& p : std::get<TriangleModel>(curved.model).mesh.points)
    p.x += 0.1 * std::sin(kHalfTurn * p.y) * std::sin(kHalfTurn * p.z);
  const MeshResult r = mesh(curved, "DBCO");
  EXPECT_TRUE(r.mesh.triangles.empty());
  expect_images(r.mesh, 1);
  EXPECT_NEAR(volume(r.mesh), 1, 0.01);
}

/// The unit cube without balls of radius r around its corners. Regions 1 to 6 are as in box(), then come the
/// pores.
Mesh cell_with_corner_pores(double r, int n) {
  TriangulatedShape shape;
  // On the ball around a corner, from which the cube lies in the directions of `signs`.
  const auto on_ball = [&](const Vec3& corner, const Vec3& signs, const Vec3& weights) {
    const Vec3 d = (r / norm(weights)) * weights;
    return corner + Vec3{signs.x * d.x, signs.y * d.y, signs.z * d.z};
  };
  const auto unit = [](int axis) { return Vec3{double(axis == 0), double(axis == 1), double(axis == 2)}; };
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {0, 1}) {
      shape.region();
      const Vec3 u = unit((axis + 1) % 3), v = unit((axis + 2) % 3), low = double(side) * unit(axis);
      std::vector<Vec3> outline;
      for (const auto& [i, j] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}})
        for (int k = 0; k <= n; ++k) {
          const double along_u = (i == j) ? k : n - k;  // the outline runs around the face
          outline.push_back(on_ball(low + double(i) * u + double(j) * v,
                                    (1.0 - 2 * i) * u + (1.0 - 2 * j) * v, along_u * u + (n - along_u) * v));
        }
      for (std::size_t k = 0; k < outline.size(); ++k) {
        const Vec3 &a = outline[k], &b = outline[(k + 1) % outline.size()], middle = low + 0.5 * (u + v);
        side == 1 ? shape.triangle(middle, a, b) : shape.triangle(middle, b, a);
      }
    }
  for (int c = 0; c < 8; ++c) {
    shape.region();
    const Vec3 corner{double(c & 1), double(c >> 1 & 1), double(c >> 2)};
    const Vec3 signs{1 - 2 * corner.x, 1 - 2 * corner.y, 1 - 2 * corner.z};
    const auto at = [&](int i, int j) {
      return on_ball(corner, signs, {double(i), double(j), double(n - i - j)});
    };
    const auto triangle = [&](const Vec3& a, const Vec3& b, const Vec3& d) {
      signs.x* signs.y* signs.z > 0 ? shape.triangle(a, d, b) : shape.triangle(a, b, d);
    };
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        triangle(at(i, j), at(i + 1, j), at(i, j + 1));
        if (i + j + 1 < n) triangle(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
      }
  }
  return shape.mesh;
}

TEST(PeriodicFaces, CellsWithPoresAtTheCornersMatch) {
  for (const double radius : {0.15, 0.3}) {
    const Mesh cell = cell_with_corner_pores(radius, 6);
    const MeshResult result = mesh(problem_of(TriangleModel{cell}, radius / 3, kCellPairs), "DBCO");
    EXPECT_TRUE(result.mesh.triangles.empty());
    expect_images(result.mesh, 3);
    // Chords make pores smaller.
    const double pores = 4.0 / 3 * kHalfTurn * std::pow(radius, 3);
    EXPECT_NEAR(volume(result.mesh), 1 - pores, 0.15 * pores);
  }
}

TEST(PeriodicFaces, FacesOfSheetsRunTheSameWay) {
  Mesh sheets = box(3);
  std::vector<std::array<int, 3>> kept;
  std::vector<int> regions;
  for (std::size_t t = 0; t < sheets.triangles.size(); ++t) {
    std::array<int, 3> v = sheets.triangles[t];
    if (sheets.triangle_region[t] > 1) continue;
    if (sheets.triangle_region[t] == 1) std::swap(v[1], v[2]);
    kept.push_back(v);
    regions.push_back(sheets.triangle_region[t]);
  }
  sheets.triangles = kept;
  sheets.triangle_region = regions;
  const MeshResult r =
      mesh(problem_of(TriangleModel{sheets}, 0.13, {{"region_1", "region_2", {{1, 0, 0}}, "p"}}), "DBCO");
  expect_images(r.mesh, 1);
  EXPECT_FALSE(r.mesh.periodic_faces[0].is_reversed);
}

TEST(PeriodicFaces, FacesThatAreCutOpenMatch) {
  const Mesh can = testing_support::can(24, 4);
  Mesh two = can;
  append(two, can, {3, 0, 0});
  const int n_faces = static_cast<int>(can.regions.size());
  for (std::size_t t = can.triangles.size(); t < two.triangles.size(); ++t) two.triangle_region[t] += n_faces;
  for (int f = 0; f < n_faces; ++f) two.regions.push_back({n_faces + f + 1, {}});
  for (const char* word : {"DB", "DBCO", "DLBCO"}) {
    const MeshResult r =
        mesh(problem_of(TriangleModel{two}, 0.21, {{"region_1", "region_4", {{3, 0, 0}}, "p"}}), word);
    EXPECT_TRUE(r.mesh.triangles.empty());
    expect_images(r.mesh, 1);
    EXPECT_FALSE(r.mesh.periodic_faces[0].is_reversed);
  }
}

TEST(PeriodicFaces, CadFacesMatch) {
  std::ostringstream file;
  try {
    write_example("fins", CadFormat::kBrep, file);
  } catch (const InputError& error) {
    if (std::string(error.what()).find("OpenCASCADE") == std::string::npos) throw;
    GTEST_SKIP() << error.what();
  }
  MeshProblem problem = problem_of(CadModel{.file = {}, .bytes = file.str()}, 2, {});
  // Its ends are the faces at z = 0 and 50.
  const MeshResult free = mesh(problem, "DB");
  std::map<int, std::array<double, 2>> heights;
  for (std::size_t q = 0; q < free.mesh.quads.size(); ++q)
    for (const int v : free.mesh.quads[q]) {
      auto& [low, high] = heights.try_emplace(free.mesh.quad_region[q], std::array{1e9, -1e9}).first->second;
      low = std::min(low, free.mesh.points[v].z), high = std::max(high, free.mesh.points[v].z);
    }
  std::array<std::string, 2> ends;
  for (const auto& [face, z] : heights)
    for (const int k : {0, 1})
      if (std::abs(z[0] - 50 * k) < 1e-6 && std::abs(z[1] - 50 * k) < 1e-6)
        ends[k] = "region_" + std::to_string(free.mesh.regions[face].tag);
  problem.periodic = {{ends[0], ends[1], {{0, 0, 50}}, "p"}};
  const MeshResult r = mesh(problem, "DBCO");
  EXPECT_TRUE(r.mesh.triangles.empty());
  expect_images(r.mesh, 1);
}

TEST(PeriodicFaces, AreWritten) {
  const TemporaryFolder folder;
  const MeshResult r = mesh(problem_of(TriangleModel{box(2)}, 0.3, kCellPairs), "DB");
  write_mesh(folder / "cell.msh", r.mesh);
  const std::string text = read_text(folder / "cell.msh");
  EXPECT_TRUE(holds(text, "\n2 2 1\n16 1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1\n",
                    "\n2 6 5\n16 1 0 0 0 0 1 0 0 0 0 1 1 0 0 0 1\n"));
  write_mesh(folder / "cell.inp", r.mesh);
  const std::string inp = read_text(folder / "cell.inp");
  EXPECT_TRUE(holds(inp, "*NSET, NSET=PERIODIC_FACE_3_MASTER\n"));
  const auto [node, master] = r.mesh.periodic_faces[2].nodes[0];
  EXPECT_TRUE(holds(
      inp, "** PERIODIC_FACE_3: " + std::to_string(node + 1) + ", " + std::to_string(master + 1) + '\n'));
  EXPECT_EQ(read_mesh(folder / "cell.msh").quads.size(), r.mesh.quads.size());
}

TEST(PeriodicFaces, WhatDoesNotMatchIsRefused) {
  const auto refused = [](const std::vector<PeriodicPair>& pairs, std::initializer_list<const char*> says,
                          const Mesh& model) {
    expect_refused(problem_of(TriangleModel{model}, 0.2, pairs), "DB", says);
  };
  const Mesh cube = box(2);
  refused({{"region_1", "region_2", {{0.9, 0, 0}}, "p 1"}},
          {"p 1: the faces do not match: the image of face 1 at", "is 0.1 away from face 2"}, cube);
  refused({{"region_1", "region_1", {{1, 0, 0}}, "p 1"}}, {"p 1: 'region_1' is 'from' and 'to'"}, cube);
  refused({{"region_1", "region_9", {{1, 0, 0}}, "p 1"}}, {"p 1: no curve and no face is called 'region_9'"},
          cube);
  refused({{"region_1", "curve_1", {{1, 0, 0}}, "p 1"}}, {"p 1: 'region_1' is a face and 'curve_1' a curve"},
          cube);
  refused({{"region_1", "region_2", {{1, 0, 0}}, "p 1"}, {"region_2", "region_1", {{-1, 0, 0}}, "p 2"}},
          {"p 2: face 1 is in two pairs"}, cube);
  // Turned by 90 degrees about its middle the face is there again, but its edges are not where others say.
  refused(
      {{"region_1", "region_2", {{1, 0, 0}, kHalfTurn / 2, {0, 0.5, 0.5}, {1, 0, 0}}, "p 1"}, kCellPairs[1]},
      {"would be the image of two curves that are not images of each other: expected one of them"}, cube);
  Mesh dented = box(4);
  for (Vec3& p : dented.points)
    if (p.x == 1 && p.y == 0.5 && p.z == 0.5) p.x = 1.01;
  refused(
      {kCellPairs[0]},
      {"p 1: the faces do not match", "the image of face 1 at (0, 0.5, 0.5) is 0.0099", "away from face 2"},
      dented);
}

TEST(PeriodicFaces, FacesTakeTheNameFromCurves) {
  Mesh cube = box(2);
  cube.regions[0].names = {"left"};
  cube.regions[1].names = {"right"};
  cube.curves.push_back({1, {"left"}});
  for (int i = 0; i < static_cast<int>(cube.points.size()); ++i)
    for (int j = 0; j < static_cast<int>(cube.points.size()); ++j) {
      const Vec3 &p = cube.points[i], &q = cube.points[j];
      if (p.x != 0 || q.x != 0 || p.y != 0 || q.y != 0 || std::abs(q.z - p.z - 0.5) > 1e-9) continue;
      cube.lines.push_back({i, j});
      cube.line_curve.push_back(0);
    }
  const MeshResult r =
      mesh(problem_of(TriangleModel{cube}, 0.2, {{"left", "right", {{1, 0, 0}}, "p"}}), "DB");
  expect_images(r.mesh, 1);
  EXPECT_TRUE(is_reported(r.warnings, "'left' is the name of faces and of curves"));
}

}  // namespace
}  // namespace delquad
