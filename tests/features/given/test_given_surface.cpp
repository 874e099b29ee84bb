// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/shape.h"
#include "tests/features/given/given.h"

namespace delquad {
namespace {

/// n x m quads whose nodes lie at `place`(i, j); rows and columns close where it says so.
Mesh woven(int n, int m, bool closes_i, bool closes_j, const std::function<Vec3(int, int)>& place) {
  Mesh mesh;
  const int columns = closes_i ? n : n + 1, rows = closes_j ? m : m + 1;
  const auto at = [&](int i, int j) { return (j % rows) * columns + i % columns; };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) mesh.points.push_back(place(i, j));
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i)
      mesh.quads.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
  mesh.quad_region.assign(mesh.quads.size(), 0);
  mesh.regions = {{1, {"skin"}}};
  return mesh;
}

/// The cube's surface, 6 n^2 quads, drawn to the unit sphere.
Mesh cube_sphere(int n) {
  Mesh mesh;
  std::map<std::array<long, 3>, int> index;
  const auto at = [&](const std::array<double, 3>& p) {
    const auto key = [](double x) { return std::lround(x * 1e6); };
    const auto [found, is_new] =
        index.emplace(std::array{key(p[0]), key(p[1]), key(p[2])}, static_cast<int>(mesh.points.size()));
    const Vec3 x{std::tan(p[0] * std::numbers::pi / 4), std::tan(p[1] * std::numbers::pi / 4),
                 std::tan(p[2] * std::numbers::pi / 4)};
    if (is_new) mesh.points.push_back((1 / norm(x)) * x);
    return found->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {-1, 1})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          std::array<int, 4> quad{};
          constexpr int kSteps[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
          for (int k = 0; k < 4; ++k) {
            std::array<double, 3> p{};
            p[axis] = side;
            p[(axis + 1) % 3] = 2.0 * (i + kSteps[k][0]) / n - 1;
            p[(axis + 2) % 3] = side * (2.0 * (j + kSteps[k][1]) / n - 1);
            quad[k] = at(p);
          }
          mesh.quads.push_back(quad);
        }
  mesh.quad_region.assign(mesh.quads.size(), 0);
  mesh.regions = {{3, {"ball"}}};
  return mesh;
}

Mesh torus_of_quads(int n, int m) {
  return woven(n, m, true, true, [&](int i, int j) {
    const double a = 2 * std::numbers::pi * i / n, b = 2 * std::numbers::pi * j / m;
    return Vec3{(3 + std::cos(b)) * std::cos(a), (3 + std::cos(b)) * std::sin(a), std::sin(b)};
  });
}

/// A quarter of an open cylinder, of 8 x 6 quads, with lines around.
Mesh open_shell() {
  Mesh mesh = woven(8, 6, false, false, [](int i, int j) {
    const double a = std::numbers::pi / 2 * i / 8;
    return Vec3{std::cos(a), std::sin(a), j / 6.0};
  });
  for (int i = 0; i < 8; ++i) mesh.lines.insert(mesh.lines.end(), {{i, i + 1}, {54 + i, 55 + i}});
  mesh.line_curve.assign(mesh.lines.size(), 0);
  mesh.curves = {{5, {"rims"}}};
  mesh.unit = "mm";
  return mesh;
}

/// Moves what `moves` says by up to this in all directions.
Mesh shaken_in_space(Mesh mesh, double by, const std::function<bool(int)>& moves,
                     const std::function<Vec3(const Vec3&)>& onto) {
  std::mt19937 random(11);
  const auto draw = [&] { return by * (2 * double(random()) / double(std::mt19937::max()) - 1); };
  for (int v = 0; v < static_cast<int>(mesh.points.size()); ++v) {
    const double x = draw(), y = draw(), z = draw();
    if (moves(v)) mesh.points[v] = onto(mesh.points[v] + Vec3{x, y, z});
  }
  return mesh;
}

using Segment3 = std::set<std::array<double, 3>>;

std::set<std::pair<int, Segment3>> lines_by_curve(const Mesh& mesh) {
  std::set<std::pair<int, Segment3>> lines;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    Segment3 ends;
    for (const int v : mesh.lines[l]) ends.insert({mesh.points[v].x, mesh.points[v].y, mesh.points[v].z});
    lines.insert({mesh.line_curve[l], ends});
  }
  return lines;
}

/// Lines to the last bit, edges of one element too; entities; and that all is well.
void expect_kept_in_space(const Mesh& given, const MeshResult& result) {
  EXPECT_TRUE(result.soundness.sound()) << result.soundness.text();
  EXPECT_EQ(lines_by_curve(result.mesh), lines_by_curve(given));
  const auto free_edges = [](const Mesh& mesh) {
    Mesh free;
    free.points = mesh.points;
    std::map<std::pair<int, int>, int> count;
    const auto add = [&](const auto& elements) {
      for (const auto& v : elements)
        for (std::size_t k = 0; k < v.size(); ++k) ++count[std::minmax({v[k], v[(k + 1) % v.size()]})];
    };
    add(mesh.triangles);
    add(mesh.quads);
    for (const auto& [edge, elements] : count)
      if (elements != 2) {
        free.lines.push_back({edge.first, edge.second});
        free.line_curve.push_back(elements);
      }
    return lines_by_curve(free);
  };
  EXPECT_EQ(free_edges(result.mesh), free_edges(given));
  expect_same_entities(result.mesh.curves, given.curves);
  expect_same_entities(result.mesh.regions, given.regions);
  EXPECT_EQ(result.mesh.unit, given.unit);
}

Vec3 onto_sphere(const Vec3& p) { return (1 / norm(p)) * p; }

TEST(GivenSurfaces, ASphereGetsBetterAndStaysRound) {
  const int n = 8;
  const Mesh given = shaken_in_space(
      cube_sphere(n), 0.06, [](int) { return true; }, onto_sphere);
  const MeshMetrics before = evaluate_metrics(given, nullptr);
  for (const char* word : {"O", "CO"}) {
    const MeshResult result = improve_given(given, word);
    expect_kept_in_space(given, result);
    EXPECT_EQ(result.surface->mesh.euler_characteristic, 2);
    EXPECT_GT(result.metrics.values.at("eta_mean"), before.values.at("eta_mean") + 0.08) << word;
    EXPECT_GT(result.metrics.values.at("eta_worst"), before.values.at("eta_worst")) << word;
    // Chords of the given edges lie this deep.
    for (const Vec3& p : result.mesh.points) EXPECT_NEAR(norm(p), 1, 0.03);
  }
}

/// An 8 x 8 grid on a cylinder, some of whose nodes inside went too far.
Mesh tangled_shell(double turn) {
  Mesh mesh = woven(8, 8, false, false, [&](int i, int j) {
    const double u = i / 8.0, v = j / 8.0;
    const double s = i == 4 && j == 4 ? u + 0.16 : u, t = i == 4 && j == 4 ? v + 0.025 : v;
    return Vec3{std::sin(turn * s), t, std::cos(turn * s)};
  });
  return mesh;
}

TEST(GivenSurfaces, WhatACureMakesWorseIsTold) {
  int told = 0, n = 0;
  for (const double turn : {1.0, 2.0, 4.0})
    for (const char* word : {"CO", "O", "C", "BCO"}) {
      SCOPED_TRACE(std::to_string(turn) + " " + word);
      const Mesh given = tangled_shell(turn);
      const MeshResult result = improve_given(given, word);
      expect_kept_in_space(given, result);
      EXPECT_TRUE(result.soundness.sound());
      double aspect = 1;
      for (const auto& quad : given.quads) {
        const auto corners = corners_of(given, quad);
        const Vec3 up = area_vector(corners);
        if (is_sound_quad(corners, up, element_shape(corners, up)))
          aspect = std::max(aspect, quad_aspect(corners));
      }
      const auto& values = result.metrics.values;
      const auto before = evaluate_metrics(given, result.prepared->size.field.get()).values;
      EXPECT_GT(before.at("n_folded"), 0);
      const bool told_of = is_reported(result.warnings, "sound now, at a price: ");
      const bool is_worse = values.at("aspect_max") > aspect * (1 + 1e-9) ||
                            values.at("edge_min") < before.at("edge_min") * (1 - 1e-9) ||
                            std::abs(values.at("n_quads") - 64) > 6.4;
      EXPECT_EQ(is_worse, told_of);
      told += told_of, ++n;
    }
  EXPECT_LT(2 * told, n);
}

/// A node of a rim went into the second row: no quad there can be a square.
TEST(GivenSurfaces, ThePriceOfACureIsToldWithItsPlace) {
  const Mesh given = woven(12, 12, false, false, [](int i, int j) {
    const double u = i / 12.0, v = i == 6 && j == 0 ? 1.5 / 12 : j / 12.0;
    return Vec3{std::sin(6 * u), 2 * v, std::cos(6 * u)};
  });
  const MeshResult result = improve_given(given, "CO");
  EXPECT_TRUE(result.soundness.sound()) << result.soundness.text();
  const auto told = std::ranges::find_if(result.warnings, [](const Warning& w) {
    return w.text.find("sound now, at a price: ") != std::string::npos;
  });
  ASSERT_NE(told, result.warnings.end());
  EXPECT_TRUE(holds(told->text, "the largest aspect of sound quads goes from ", " at ("));
}

/// A node of one rim nearly meets the other rim: what lies between them is poor where it is sound.
TEST(GivenSurfaces, ACureThatMakesQuadsPoorIsAskedFor) {
  MeshProblem problem;
  problem.model = GivenMesh{woven(8, 3, false, false, [](int i, int j) {
    const double u = i / 8.0, v = i == 4 && j == 0 ? 0.99 : j / 3.0;
    return Vec3{std::sin(u), 0.4 * v, std::cos(u)};
  })};
  try {
    mesh(problem, "CO");
    ADD_FAILURE() << "poor quads are taken";
  } catch (const UnsoundError& error) {
    const std::string text = error.what();
    EXPECT_TRUE(holds(text, "become sound only at a price: ", "--set repair.at_any_price=true takes it"));
  }
  problem.options.set("repair.at_any_price", true);
  EXPECT_GT(mesh(problem, "CO").metrics.values.at("aspect_max"), 20);
}

TEST(GivenSurfaces, TrianglesOfATorusAreMerged) {
  const Mesh given = halved(torus_of_quads(36, 12), 3);
  const MeshResult result = improve_given(given, "BCO");
  expect_kept_in_space(given, result);
  EXPECT_TRUE(result.mesh.triangles.empty());
  EXPECT_EQ(result.surface->mesh.euler_characteristic, 0);
  EXPECT_GT(result.metrics.values.at("eta_mean"), 0.85);
  for (const Vec3& p : result.mesh.points) EXPECT_NEAR(std::hypot(std::hypot(p.x, p.y) - 3, p.z), 1, 0.06);
}

TEST(GivenSurfaces, AnOpenShellKeepsItsOutlineNamesAndUnit) {
  Mesh given = open_shell();
  given.named_points = {{2 * 9 + 3, {5, {"sensor"}}}};
  const auto onto = [](const Vec3& p) {
    const double r = std::hypot(p.x, p.y);
    return Vec3{p.x / r, p.y / r, p.z};
  };
  const auto is_inside = [](int v) { return v % 9 != 0 && v % 9 != 8 && v > 8 && v < 54; };
  given = shaken_in_space(given, 0.05, is_inside, onto);
  const MeshResult result = improve_given(given, "CO");
  expect_kept_in_space(given, result);
  EXPECT_GT(result.metrics.values.at("eta_mean"), evaluate_metrics(given, nullptr).values.at("eta_mean"));
  ASSERT_EQ(result.mesh.named_points.size(), 1u);
  EXPECT_EQ(result.mesh.points[result.mesh.named_points[0].point], given.points[2 * 9 + 3]);
  EXPECT_EQ(result.mesh.named_points[0].entity.names, std::vector<std::string>{"sensor"});
  expect_kept_in_space(halved(given, 3), improve_given(halved(given, 3), "BCO"));
}

/// A single line inside, which bounds nothing.
TEST(GivenSurfaces, LinesInsideStay) {
  Mesh given = open_shell();
  given.lines.push_back({2 * 9 + 3, 2 * 9 + 4});
  given.line_curve.push_back(1);
  given.curves.push_back({8, {"wire"}});
  expect_kept_in_space(given, improve_given(given, "CO"));
  given.lines.insert(given.lines.end(), {{2 * 9 + 4, 3 * 9 + 4}, {3 * 9 + 4, 4 * 9 + 4}});
  given.line_curve.resize(given.lines.size(), 1);
  expect_kept_in_space(halved(given, 3), improve_given(halved(given, 3), "BCO"));
}

/// Three squares on one edge; the second one stands upright.
Mesh rib(int n) {
  Mesh mesh;
  std::map<std::array<int, 3>, int> index;
  const auto at = [&](int x, int y, int z) {
    const auto [found, is_new] = index.emplace(std::array{x, y, z}, static_cast<int>(mesh.points.size()));
    if (is_new) mesh.points.push_back({double(x) / n, double(y) / n, double(z) / n});
    return found->second;
  };
  const std::array<std::array<int, 2>, 3> sheets{{{1, 0}, {-1, 0}, {0, 1}}};
  for (int s = 0; s < 3; ++s) {
    const auto [dx, dz] = sheets[s];
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        mesh.quads.push_back({at(i * dx, j, i * dz), at((i + 1) * dx, j, (i + 1) * dz),
                              at((i + 1) * dx, j + 1, (i + 1) * dz), at(i * dx, j + 1, i * dz)});
        mesh.quad_region.push_back(s == 2 ? 1 : 0);
      }
  }
  mesh.regions = {{1, {"plate"}}, {2, {"rib"}}};
  return mesh;
}

TEST(GivenSurfaces, SheetsMayShareAnEdge) {
  const int n = 6;
  Mesh given = rib(n);
  std::map<int, int> elements;
  for (const auto& quad : given.quads)
    for (const int v : quad) ++elements[v];
  given = shaken_in_space(
      given, 0.05, [&](int v) { return elements[v] == 4 && given.points[v].x != 0; },
      [](const Vec3& p) {
        return Vec3{p.x, p.y, 0};
      });
  for (const char* word : {"O", "CO"}) {
    const MeshResult result = improve_given(given, word);
    expect_kept_in_space(given, result);
    EXPECT_EQ(result.surface->mesh.branching_edges, n);
    EXPECT_GT(result.metrics.values.at("eta_mean"), 0.97);
  }
}

/// Without any line or region: the edges of the cube are sharp.
TEST(GivenSurfaces, SharpEdgesStay) {
  Mesh given = cube_sphere(5);
  for (Vec3& p : given.points) p = (1 / std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)})) * p;
  const auto sides = [](const Vec3& p) {
    return (std::abs(p.x) > 1 - 1e-9) + (std::abs(p.y) > 1 - 1e-9) + (std::abs(p.z) > 1 - 1e-9);
  };
  const auto on_edges = [&](const Mesh& mesh) {
    std::set<std::array<double, 3>> found;
    for (const Vec3& p : mesh.points)
      if (sides(p) > 1) found.insert({p.x, p.y, p.z});
    return found;
  };
  for (auto& quad : given.quads) {
    if (quad[0] % 3 == 0) std::ranges::reverse(quad);  // elements may run either way round
  }
  const MeshResult result = improve_given(given, "CO");
  expect_kept_in_space(given, result);
  EXPECT_EQ(on_edges(result.mesh), on_edges(given));
  for (const Vec3& p : result.mesh.points) EXPECT_GE(sides(p), 1);
}

/// A tee of quads with a triangle or two among them.
TEST(GivenSurfaces, TrianglesAmongQuadsStay) {
  Mesh given = open_shell();
  const auto [a, b, c, d] = given.quads[20];
  given.triangles = {{a, b, c}, {a, c, d}};
  given.triangle_region = {0, 0};
  given.quads.erase(given.quads.begin() + 20);
  given.quad_region.pop_back();
  const MeshResult result = improve_given(given, "CO");
  expect_kept_in_space(given, result);
  EXPECT_EQ(result.mesh.triangles.size(), 2u);
}

/// A quad of the shell that became a line, two nodes in one place, and a node beyond its neighbor.
TEST(GivenSurfaces, QuadsWithoutAreaAreMended) {
  const Mesh shell = open_shell();
  const int corner = 2 * 9 + 3;
  const auto between = [&](double part) {
    return shell.points[corner] + part * (shell.points[corner + 1] - shell.points[corner]);
  };
  Mesh line = shell, edge = shell, beyond = shell;
  line.points[corner + 9] = between(0.25);
  line.points[corner + 10] = between(0.75);
  edge.points[corner] = edge.points[corner + 1];
  beyond.points[corner] = between(1.3);
  for (const Mesh& given : {line, edge, beyond})
    for (const char* word : {"CO", "O"}) {
      const MeshResult result = improve_given(given, word);
      EXPECT_TRUE(result.soundness.sound()) << result.soundness.text();
      EXPECT_EQ(result.mesh.quads.size(), shell.quads.size());
      EXPECT_GT(result.metrics.values.at("eta_worst"), 0.5);
      ASSERT_FALSE(result.warnings.empty());
      EXPECT_TRUE(holds(result.warnings[0].text, "inverted, folded or without area"));
    }
}

TEST(GivenSurfaces, WhatCannotBeUsedIsNamed) {
  const Mesh shell = open_shell();
  Mesh hanging = shell;  // below its first edge two quads, which meet in the middle of that
  const int first = static_cast<int>(hanging.points.size());
  const Vec3 from = shell.points[0], to = shell.points[1], down{0, 0, -0.2};
  hanging.points.insert(hanging.points.end(),
                        {0.5 * (from + to), from + down, 0.5 * (from + to) + down, to + down});
  hanging.quads.insert(hanging.quads.end(),
                       {{first + 1, first + 2, first, 0}, {first + 2, first + 3, 1, first}});
  hanging.quad_region.resize(hanging.quads.size(), 0);
  expect_input_error([&] { improve_given(hanging, "CO"); }, {"hanging node"});

  Mesh twice = shell;
  twice.quads[3] = twice.quads[4];
  expect_input_error([&] { improve_given(twice, "CO"); }, {"is there twice"});

  Mesh flat = shell;
  flat.quads[0] = {0, 1, 1, 9};
  expect_input_error([&] { improve_given(flat, "CO"); }, {"a corner twice"});

  Mesh thin = halved(shell, 3);
  thin.points[thin.triangles[9][2]] =
      0.5 * (thin.points[thin.triangles[9][0]] + thin.points[thin.triangles[9][1]]);
  expect_input_error([&] { improve_given(thin, "BCO"); }, {"no area"});

  const int n = 24;
  const Mesh moebius = [&] {
    Mesh band = woven(n, 2, false, false, [&](int i, int j) {
      const double a = 2 * std::numbers::pi * i / n, w = 0.4 * (j - 1);
      return Vec3{(1 + w * std::cos(a / 2)) * std::cos(a), (1 + w * std::cos(a / 2)) * std::sin(a),
                  w * std::sin(a / 2)};
    });
    // The last column is the first one upside down.
    for (auto& quad : band.quads)
      for (int& v : quad)
        if (v % (n + 1) == n) v = (2 - v / (n + 1)) * (n + 1);
    return band;
  }();
  expect_input_error([&] { improve_given(moebius, "CO"); }, {"Moebius", "found at the edge"});
  expect_input_error([&] { improve_given(halved(shell, 3), "CO"); }, {"triangles", "B"});
}

/// Pipelines in two steps do about the same as in one.
TEST(GivenSurfaces, TheBracketInTwoSteps) {
  MeshProblem problem = problem_of(ExampleModel{"bracket"}, 4);
  const auto whole = mesh(problem, "DBCO").metrics.values;
  const Mesh start = mesh(problem, "DB").mesh;
  problem.model = GivenMesh{start};
  const MeshResult result = mesh(problem, "CO");
  expect_kept_in_space(start, result);
  EXPECT_GT(result.metrics.values.at("eta_mean"), whole.at("eta_mean") - 0.02);
  EXPECT_GT(result.metrics.values.at("d4"), whole.at("d4") - 8);
}

}  // namespace
}  // namespace delquad
