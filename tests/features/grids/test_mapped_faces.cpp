// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"

namespace delquad {
namespace {

constexpr double kPi = std::numbers::pi;

PlanarModel quarter_ring() {
  return ModelMaker().loop({make_arc({0, 0}, 1, 0, kPi / 2), make_segment({0, 1}, {0, 2}),
                            make_arc({0, 0}, 2, 0, kPi / 2), make_segment({1, 0}, {2, 0})},
                           "ring", {"inner", "left", "outer", "right"});
}

/// Blocks side by side, which bend, and a free face at their end.
PlanarModel row_of_blocks(int n) {
  ModelMaker model;
  const auto low = [](int i) { return Vec2{i + 0.2 * std::sin(3.0 * i), 0.2 * std::sin(1.0 * i)}; };
  const auto high = [&](int i) { return Vec2{low(i).x + 0.1, 1 + 0.2 * std::cos(1.0 * i)}; };
  for (int i = 0; i <= n; ++i) model.curve(make_segment(low(i), high(i)), "wall");
  for (int i = 0; i < n; ++i) {
    const int first = static_cast<int>(model.curves.size());
    model.curve(make_segment(low(i), low(i + 1)), "floor").curve(make_segment(high(i), high(i + 1)), "roof");
    model.loop_of({first, i + 1, first + 1, i}, "block");
  }
  const Vec2 a = low(n), b = high(n);
  model.curve(make_polyline({a, {a.x + 2, -1}, {a.x + 2.5, 1.6}, b}), "end");
  return model.loop_of({n, static_cast<int>(model.curves.size()) - 1}, "free");
}

/// A square with a hole, cut into four blocks from the corners on.
PlanarModel plate_of_blocks() {
  ModelMaker model;
  const auto at = [](double r, int k) {
    const double angle = kPi / 4 + k * kPi / 2;
    return Vec2{r * std::cos(angle), r * std::sin(angle)};
  };
  for (int k = 0; k < 4; ++k) {
    model.curve(make_arc({0, 0}, 0.4, kPi / 4 + k * kPi / 2, kPi / 4 + (k + 1) * kPi / 2), "hole");
    model.curve(make_segment(at(1.2, k), at(1.2, k + 1)), "side").curve(make_segment(at(0.4, k), at(1.2, k)));
  }
  for (int k = 0; k < 4; ++k) model.loop_of({3 * k, 3 * ((k + 1) % 4) + 2, 3 * k + 1, 3 * k + 2}, "block");
  return model;
}

/// Sixteen of these side by side, each side of a square once.
PlanarModel plate_with_16_holes() {
  ModelMaker model;
  const auto corner = [](int i, int j) { return Vec2{1.0 * i, 1.0 * j}; };
  const auto segment = [&](Vec2 a, Vec2 b, const char* name) {
    model.curve(make_segment(a, b), name);
    return static_cast<int>(model.curves.size()) - 1;
  };
  int across[4][5], along[5][4];
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 5; ++j) across[i][j] = segment(corner(i, j), corner(i + 1, j), "side");
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 4; ++j) along[i][j] = segment(corner(i, j), corner(i, j + 1), "side");
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      const Vec2 centre = {i + 0.5, j + 0.5};
      const auto on_hole = [&](int k) {
        const double angle = -3 * kPi / 4 + k * kPi / 2;
        return centre + Vec2{0.28 * std::cos(angle), 0.28 * std::sin(angle)};
      };
      const Vec2 corners[] = {corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)};
      const int sides[] = {across[i][j], along[i + 1][j], across[i][j + 1], along[i][j]};
      int arcs[4], spokes[4];
      for (int k = 0; k < 4; ++k) {
        const double angle = -3 * kPi / 4 + k * kPi / 2;
        model.curve(make_arc(centre, 0.28, angle, angle + kPi / 2), "hole");
        arcs[k] = static_cast<int>(model.curves.size()) - 1;
        spokes[k] = segment(on_hole(k), corners[k], "");
      }
      for (int k = 0; k < 4; ++k) model.loop_of({sides[k], spokes[(k + 1) % 4], arcs[k], spokes[k]}, "block");
    }
  return model;
}

MeshProblem mapped_problem(PlanarModel model, double size, MappedSpec mapped) {
  MeshProblem problem = problem_of(std::move(model), size);
  problem.mapped = std::move(mapped);
  return problem;
}

/// Inner nodes of these regions with other than four quads.
int irregular_inside(const Mesh& mesh, const std::string& region) {
  std::vector<int> quads(mesh.points.size(), 0), of_others(mesh.points.size(), 0);
  for (std::size_t q = 0; q < mesh.quads.size(); ++q)
    for (const int v : mesh.quads[q]) {
      ++quads[v];
      if (mesh.regions[mesh.quad_region[q]].names != std::vector{region}) of_others[v] = 1;
    }
  for (const auto& line : mesh.lines)
    for (const int v : line) of_others[v] = 1;
  int irregular = 0;
  for (std::size_t v = 0; v < quads.size(); ++v) irregular += of_others[v] == 0 && quads[v] != 4;
  return irregular;
}

TEST(MappedFaces, ARingIsAGrid) {
  for (const std::string word : {"DB", "DBCO", "FLBCO"}) {
    for (const MappedSpec& spec : {MappedSpec{{"ring"}}, MappedSpec{{}, true}}) {
      const MeshResult r = mesh(mapped_problem(quarter_ring(), 0.1, spec), word);
      EXPECT_EQ(irregular_inside(r.mesh, "ring"), 0);
      const auto along = std::count(r.mesh.line_curve.begin(), r.mesh.line_curve.end(), 0);
      EXPECT_EQ(along, std::count(r.mesh.line_curve.begin(), r.mesh.line_curve.end(), 2));
      EXPECT_EQ(r.mesh.quads.size(), along * 10u);
      if (spec.automatic && word != "DB") continue;  // O has moved it
      // The grid follows polar coordinates.
      for (const Vec3& x : r.mesh.points) {
        const double step = norm(x) * 10;
        EXPECT_NEAR(step, std::round(step), 1e-9);
      }
    }
  }
  const MeshResult plain = mesh(mapped_problem(quarter_ring(), 0.1, {}), "DBCO");
  EXPECT_GT(irregular_inside(plain.mesh, "ring"), 0);
}

TEST(MappedFaces, ChainsAgreeOnTheirEdges) {
  const MeshResult r = mesh(mapped_problem(row_of_blocks(10), 0.13, {{"block"}}), "DBCO");
  EXPECT_EQ(irregular_inside(r.mesh, "block"), 0);
  EXPECT_TRUE(r.mesh.triangles.empty());
  std::vector<int> edges(r.mesh.curves.size(), 0);
  for (const int c : r.mesh.line_curve) ++edges[c];
  for (int i = 1; i <= 10; ++i) EXPECT_EQ(edges[i], edges[0]);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(edges[11 + 2 * i], edges[12 + 2 * i]);
}

/// Sizes follow the short edges of a grid, and do not make more of them.
TEST(MappedFaces, NeighboursDoNotMakeAGridFiner) {
  ModelMaker model =
      ModelMaker().polygon({{0, 0}, {3, 0}, {2, 1}, {1, 1}}, {"long", "shared", "short", "other"}, "grid");
  const auto counts = [](const PlanarModel& m) {
    MeshProblem problem = problem_of(m, 0.1);
    problem.mapped.names = {"grid"};
    const Mesh mesh = delquad::mesh(problem, "DB").mesh;
    std::array<int, 4> n{};
    for (const int curve : mesh.line_curve)
      if (curve < 4) ++n[curve];
    return n;
  };
  const auto alone = counts(model);
  EXPECT_EQ(alone, (std::array{17, 14, 17, 14}));
  model.curve(make_polyline({{3, 0}, {3, 3}, {2, 2}, {2, 1}}), "rest").loop_of({1, 4}, "free");
  EXPECT_EQ(counts(model), alone);
}

TEST(MappedFaces, AroundAHole) {
  const MeshResult r = mesh(mapped_problem(plate_of_blocks(), 0.05, {{"block"}}), "DBCO");
  EXPECT_EQ(r.metrics.values.at("d4"), 100);
  EXPECT_GT(r.metrics.values.at("eta_worst"), 0.4);
  MeshProblem divided = mapped_problem(plate_of_blocks(), 0.05, {{"block"}});
  divided.divisions = {{"hole", 9, 1, 1, "d 1"}, {"curve_3", 12, 1.2, 1, "d 2"}};
  const MeshResult d = mesh(divided, "DBCO");
  EXPECT_EQ(d.mesh.quads.size(), 4u * 9 * 12);
  divided.divisions.push_back({"curve_2", 10, 1, 1, "d 3"});
  expect_refused(divided, "DBCO",
                 {"'block' with sides that do not match", "'hole' (9 edges)", "'side' (10 edges)"});
}

bool all_convex(const Mesh& mesh) {
  for (const auto& quad : mesh.quads)
    for (int k = 0; k < 4; ++k) {
      const Vec3 &a = mesh.points[quad[k]], &b = mesh.points[quad[(k + 1) % 4]],
                 &c = mesh.points[quad[(k + 2) % 4]];
      if (!(cross(b - a, c - b).z > 0)) return false;
    }
  return true;
}

/// Nodes on no line, by their number of quads.
std::map<int, int> valences_inside(const Mesh& mesh) {
  std::vector<int> quads(mesh.points.size(), 0);
  for (const auto& quad : mesh.quads)
    for (const int v : quad) ++quads[v];
  for (const auto& line : mesh.lines)
    for (const int v : line) quads[v] = 0;
  std::map<int, int> count;
  for (const int n : quads) ++count[n];
  count.erase(0);
  return count;
}

TEST(MappedFaces, APlateWith16HolesAsBlocks) {
  const MeshResult r = mesh(mapped_problem(plate_with_16_holes(), 0.06, {{"block"}}), "DBCO");
  EXPECT_TRUE(r.mesh.triangles.empty());
  EXPECT_TRUE(all_convex(r.mesh));
  EXPECT_EQ(irregular_inside(r.mesh, "block"), 0);
  // Each arc has as many edges as the side of the square that faces it; all four spokes of a square agree.
  std::vector<int> edges(r.mesh.curves.size(), 0);
  for (const int c : r.mesh.line_curve) ++edges[c];
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      const int first = 40 + 8 * (4 * i + j);
      const int sides[] = {5 * i + j, 20 + 4 * (i + 1) + j, 5 * i + j + 1, 20 + 4 * i + j};
      for (int k = 0; k < 4; ++k) {
        EXPECT_EQ(edges[first + 2 * k], edges[sides[k]]);
        EXPECT_GE(edges[sides[k]], 9);
      }
    }
}

TEST(MappedFaces, ThreeSidesMeetInAMiddle) {
  PlanarModel model = polygons({{{0, 0}, {1, 0}, {0.4, 0.9}}});
  model.loops[0].region = "wedge";
  model.curves.push_back({make_arc({0, 0}, 1, -kPi / 2, 0), "rim", {}});
  model.curves.push_back({make_segment({0, 0}, {0, -1}), "down", {}});
  const int axis = static_cast<int>(model.curves.size());
  model.curves.push_back({make_segment({0, 0}, {1, 0}), "axis", {}});
  model.loops.push_back({{axis - 2, axis - 1, axis}, "sector", {}});
  for (const char* word : {"DB", "DBCO"}) {
    const MeshResult r = mesh(mapped_problem(model, 0.1, {{"wedge", "sector"}}), word);
    EXPECT_TRUE(all_convex(r.mesh));
    EXPECT_EQ(valences_inside(r.mesh)[3], 2);
    EXPECT_EQ(valences_inside(r.mesh).size(), 2u);  // all others have four
    EXPECT_GT(r.metrics.values.at("eta_worst"), 0.4);
  }
  MeshProblem divided = mapped_problem(model, 0.1, {{"wedge", "sector"}});
  divided.divisions = {{"rim", 40, 1, 1, "d 1"}, {"down", 6, 1, 1, "d 2"}, {"axis", 6, 1, 1, "d 3"}};
  expect_refused(divided, "DBCO", {"'sector'", "40", "6", "less than the two others together"});
}

TEST(MappedFaces, CornersAreTold) {
  // A regular octagon: any four of its corners will do.
  std::vector<Vec2> octagon;
  for (int k = 0; k < 8; ++k) octagon.push_back({std::cos(k * kPi / 4), std::sin(k * kPi / 4)});
  PlanarModel model = polygons({octagon});
  model.loops[0].region = "nut";
  model.points = {{octagon[1], "p1", {}}, {octagon[3], "p3", {}}};
  MappedSpec spec;
  spec.corners = {{"nut", {{"p1"}, {"p3"}, {{}, {-0.7071, -0.7071, 0}}, {{}, {0.7071, -0.7071, 0}}}, "m 7"}};
  const MeshResult r = mesh(mapped_problem(model, 0.1, spec), "DBCO");
  EXPECT_EQ(irregular_inside(r.mesh, "nut"), 0);
  EXPECT_TRUE(all_convex(r.mesh));
  // The corners have one quad each, all other nodes on the outline two.
  std::vector<int> quads(r.mesh.points.size(), 0);
  for (const auto& quad : r.mesh.quads)
    for (const int v : quad) ++quads[v];
  int single = 0;
  for (std::size_t v = 0; v < quads.size(); ++v)
    if (quads[v] == 1) {
      ++single;
      EXPECT_NEAR(std::abs(r.mesh.points[v].x), std::sqrt(0.5), 1e-9);
    }
  EXPECT_EQ(single, 4);
  const auto refused = [&](std::vector<GridCorner> corners, std::initializer_list<const char*> says) {
    MappedSpec wrong;
    wrong.corners = {{"nut", std::move(corners), "m 7"}};
    expect_refused(mapped_problem(model, 0.1, wrong), "DBCO", says);
  };
  refused({{"p1"}, {"p3"}, {"p5"}}, {"m 7: no point is called 'p5'; did you mean"});
  refused({{"p1"}, {"p3"}}, {"m 7: 'nut' is given 2 corner(s): expected 3 or 4"});
  refused({{"p1"}, {"p3"}, {{}, {0, 0, 0}}}, {"m 7: (0, 0) is no node of the outline of 'nut'"});
  refused({{"p1"}, {"p3"}, {"p3"}}, {"is a corner of 'nut' twice"});
  MappedSpec unknown;
  unknown.corners = {{"not", {{"p1"}, {"p3"}, {"p1"}}, "m 8"}};
  expect_refused(mapped_problem(model, 0.1, unknown), "DBCO",
                 {"m 8: no region is called 'not'; did you mean 'nut'?"});
}

TEST(MappedFaces, RingsCloseAround) {
  const PlanarModel model = ModelMaker().circle({0, 0}, 1.8, "outer", "ring").circle({0.05, 0}, 1.3, "inner");
  for (const MappedSpec& spec : {MappedSpec{{"ring"}}, MappedSpec{{}, true}}) {
    const MeshResult r = mesh(mapped_problem(model, 0.1, spec), "DBCO");
    EXPECT_TRUE(all_convex(r.mesh));
    EXPECT_EQ(valences_inside(r.mesh).size(), 1u);
    const auto inner = std::count(r.mesh.line_curve.begin(), r.mesh.line_curve.end(), 0);
    EXPECT_EQ(inner, std::count(r.mesh.line_curve.begin(), r.mesh.line_curve.end(), 1));
    EXPECT_EQ(r.mesh.quads.size(), inner * 5u);
  }
}

/// Belongs to a mesh by a constant size 1.
struct Rows {
  std::size_t quads = 0;
  long outer = 0;                                                          ///< edges of the first curve
  int irregular = 0;                                                       ///< nodes inside
  double shortest = std::numeric_limits<double>::infinity(), longest = 0;  ///< sides
};

Rows rows_of(const PlanarModel& model, const std::string& word) {
  const Mesh mesh = delquad::mesh(mapped_problem(model, 1, {}), word).mesh;
  Rows rows{mesh.quads.size(), std::ranges::count(mesh.line_curve, 0),
            irregular_inside(mesh, mesh.regions.at(0).names.at(0))};
  for (const auto& quad : mesh.quads)
    for (int k = 0; k < 4; ++k) {
      const double length = norm(mesh.points[quad[k]] - mesh.points[quad[(k + 1) % 4]]);
      rows.shortest = std::min(rows.shortest, length);
      rows.longest = std::max(rows.longest, length);
    }
  return rows;
}

PlanarModel ring(double width, double off) {
  return ModelMaker().circle({0, 0}, 5, "outer", "ring").circle({off, 0}, 5 - width, "inner");
}

TEST(MappedFaces, NarrowRingsAreRows) {
  for (const char* word : {"DB", "DBCO"})
    for (const double width : {0.4, 0.6, 0.8, 1.0, 1.2, 1.6, 2.4})
      for (const double off : {0.0, 0.15 * width}) {
        SCOPED_TRACE(testing::Message() << word << ' ' << width << ' ' << off);
        const Rows rows = rows_of(ring(width, off), word);
        // Circles have the mean of what both want, by logarithms.
        const double around = 2 * kPi * std::sqrt(5 * (5 - width));
        EXPECT_NEAR(static_cast<double>(rows.outer), around, 1);
        EXPECT_EQ(rows.quads, rows.outer * std::max(1L, std::lround(width)));
        EXPECT_EQ(rows.irregular, 0);
        EXPECT_GE(rows.shortest, 0.33);
        EXPECT_LE(rows.longest, 1.75);
      }
  // Rows of the mean width would be too wide where the ring is widest.
  const Rows wide = rows_of(ring(2.4, 1.2), "DBCO");
  EXPECT_EQ(wide.quads % 3, 0u);
  EXPECT_LE(wide.longest, 1.75);
  // No number of rows is right where it is 0.6 and where it is 1.8 wide: the ring stays free.
  const Rows uneven = rows_of(ring(1.2, 0.6), "DBCO");
  EXPECT_GT(uneven.irregular, 0);
  EXPECT_GE(uneven.shortest, 0.33);
  EXPECT_LE(uneven.longest, 1.75);
}

/// Half a ring of radius 5 outside, so wide at its ends.
PlanarModel half_ring(double width, double to_width) {
  const double r = 5 - (width + to_width) / 2, x = (to_width - width) / 2;
  return ModelMaker().loop({make_arc({0, 0}, 5, 0, kPi), make_segment({-5, 0}, {x - r, 0}),
                            make_arc({x, 0}, r, 0, kPi), make_segment({x + r, 0}, {5, 0})},
                           "band", {"outer", "end", "inner", "begin"});
}

TEST(MappedFaces, NarrowBandsAreRowsToTheirEnds) {
  for (const char* word : {"DB", "DBCO"})
    for (const auto& [width, to_width] :
         {std::pair(0.8, 0.8), {0.6, 1.0}, {1.3, 0.4}, {1.7, 1.7}, {2.2, 1.6}}) {
      SCOPED_TRACE(testing::Message() << word << ' ' << width << ' ' << to_width);
      const Rows rows = rows_of(half_ring(width, to_width), word);
      const double mean = (width + to_width) / 2;
      EXPECT_NEAR(static_cast<double>(rows.outer), kPi * std::sqrt(5 * (5 - mean)), 1);
      EXPECT_EQ(rows.quads, rows.outer * std::lround(mean));
      EXPECT_EQ(rows.irregular, 0);
      EXPECT_GE(rows.shortest, 0.33);
      EXPECT_LE(rows.longest, 1.75);
    }
}

/// A face that cannot be a grid is meshed, and told of, as if it were wide.
TEST(MappedFaces, NarrowFacesAreNoDemand) {
  MeshProblem problem = mapped_problem(half_ring(0.8, 0.8), 1, {});
  problem.divisions = {{"outer", 20, 1, 1, "d 1"}, {"inner", 12, 1, 1, "d 2"}};
  EXPECT_TRUE(mesh(problem, "DBCO").mesh.triangles.empty());
  for (const char* name : {"begin", "end"}) problem.divisions.push_back({name, 1, 1, 1, "d 3"});
  problem.divisions[1].edges = 13;
  expect_refused(problem, "DBCO", {"the given numbers of edges leave 'band' with an odd number around it"});
}

TEST(MappedFaces, WhatWouldFoldIsSmoothed) {
  PlanarModel model = polygons({{{0, 0}, {2, 0}, {2, 1}, {1.1, 1}, {1, 0.15}, {0.9, 1}, {0, 1}}});
  model.loops[0].region = "notch";
  const MeshResult r = mesh(mapped_problem(model, 0.08, {{"notch"}}), "DBCO");
  EXPECT_TRUE(all_convex(r.mesh));
  EXPECT_EQ(irregular_inside(r.mesh, "notch"), 0);
}

TEST(MappedFaces, WhatCannotBeAGridIsRefused) {
  const auto refused = [](PlanarModel model, MappedSpec spec, std::initializer_list<const char*> says) {
    spec.where = "m 1";
    expect_refused(mapped_problem(std::move(model), 0.2, spec), "DBCO", says);
  };
  refused(quarter_ring(), {{"rong"}}, {"m 1: no region is called 'rong'; did you mean 'ring'?"});
  refused(ModelMaker().circle({0, 0}, 1, "rim", "disk"), {{"disk"}},
          {"'disk' cannot be a grid: its outline has 1 corner"});
  PlanarModel holed = quarter_ring();
  holed.curves.push_back({make_circle({1, 1}, 0.2), "hole", {}});
  holed.loops.push_back({{4}, {}, {}});
  refused(holed, {{"ring"}}, {"'ring' cannot be a grid: something lies inside of it"});
  EXPECT_GT(mesh(mapped_problem(holed, 0.2, {{}, true}), "DBCO").mesh.quads.size(), 0u);
  refused(ModelMaker().polygon({{0, 0}, {1, 1}, {0, 0.2}, {-1, 1}}, {""}, "arrow"), {{"arrow"}},
          {"'arrow' cannot be a grid: it would fold at ("});
  refused(ModelMaker().loop({make_arc({0, 0}, 1, 0, kPi), make_segment({-1, 0}, {1, 0})}, "half"), {{"half"}},
          {"'half' cannot be a grid: its outline has 2 corner(s): expected at least 3"});
}

}  // namespace
}  // namespace delquad
