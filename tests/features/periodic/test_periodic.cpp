// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/mesh_io.h"
#include "tests/support/meshing.h"
#include "tests/support/named_lines.h"

namespace delquad {
namespace {

/// A square with a circular hole, and halves of a hole that its left and right side cut through.
PlanarModel unit_cell() {
  const double r = 0.2, pi = std::numbers::pi;
  return ModelMaker()
      .loop({make_segment({0, 0}, {1, 0}), make_segment({1, 0}, {1, 0.5 - r}),
             make_arc({1, 0.5}, r, 1.5 * pi, 0.5 * pi), make_segment({1, 0.5 + r}, {1, 1}),
             make_segment({0, 1}, {1, 1}), make_segment({0, 0.5 + r}, {0, 1}),
             make_arc({0, 0.5}, r, -0.5 * pi, 0.5 * pi), make_segment({0, 0}, {0, 0.5 - r})},
            "", {"bottom", "right", "pore", "right", "top", "left", "pore", "left"})
      .circle({0.5, 0.5}, 0.15, "hole");
}

MeshProblem cell_problem(PlanarModel model, double size) {
  MeshProblem problem = problem_of(std::move(model), size);
  problem.cross.kind = CrossKind::kSizeAware;
  problem.periodic = {{"left", "right", {{1, 0, 0}}, "p 1"}, {"bottom", "top", {{0, 1, 0}}, "p 2"}};
  return problem;
}

/// Every node of `to` is the image of just one of `from`, as the mesh says.
void expect_images(const Mesh& mesh, const std::string& from, const std::string& to) {
  std::map<int, int> of;
  for (const PeriodicNodes& pair : mesh.periodic) {
    if (mesh.curves[pair.curve].names != std::vector{to} ||
        mesh.curves[pair.master].names != std::vector{from})
      continue;
    for (const auto& [node, master] : pair.nodes) {
      EXPECT_LT(norm(pair.motion(mesh.points[master]) - mesh.points[node]), 1e-14);
      EXPECT_TRUE(of.emplace(node, master).second || of[node] == master);
    }
  }
  std::set<int> images, masters;
  for (const auto& [node, master] : of) images.insert(node), masters.insert(master);
  EXPECT_EQ(images, nodes_named(mesh, to));
  EXPECT_EQ(masters, nodes_named(mesh, from));
}

TEST(Periodic, CellsWithHolesMatch) {
  for (const double size : {0.11, 0.05, 0.021}) {
    for (const long long seed : {0, 7}) {
      MeshProblem problem = cell_problem(unit_cell(), size);
      problem.seed = seed;
      const MeshResult r = mesh(problem, "DBCO");
      EXPECT_TRUE(r.mesh.triangles.empty());
      EXPECT_EQ(r.mesh.periodic.size(), 3u);
      expect_images(r.mesh, "left", "right");
      expect_images(r.mesh, "bottom", "top");
    }
  }
}

TEST(Periodic, SizesOnTheFirstSideCount) {
  MeshProblem problem = cell_problem(unit_cell(), 0.1);
  problem.size.field = make_function_size([](const Vec3& x) { return 0.02 + 0.1 * x.x; }, "size");
  const MeshResult r = mesh(problem, "DBCO");
  EXPECT_TRUE(r.mesh.triangles.empty());
  expect_images(r.mesh, "left", "right");
}

TEST(Periodic, ImagesMayHaveImages) {
  const auto square = [](double x) { return std::vector<Vec2>{{x, 0}, {x + 1, 0}, {x + 1, 1}, {x, 1}}; };
  MeshProblem problem = problem_of(ModelMaker()
                                       .polygon(square(0), {"low", "second", "high", "first"}, "one")
                                       .polygon(square(2), {"base", "end", "top", "third"}, "two"));
  problem.size.field =
      make_function_size([](const Vec3& x) { return 0.03 + 0.1 * (x.x - 1.7) * (x.x - 1.7) * x.y; }, "size");
  problem.periodic = {{"second", "third", {{1, 0, 0}}, "p 1"}, {"first", "second", {{1, 0, 0}}, "p 2"}};
  const MeshResult r = mesh(problem, "DBCO");
  expect_images(r.mesh, "first", "second");
  expect_images(r.mesh, "second", "third");
  problem.periodic[1].to = "third";
  expect_refused(problem, "DBCO", {"p 2: the sides do not match"});
}

TEST(Periodic, SectorsTurn) {
  const double third = 2 * std::numbers::pi / 3;
  const Vec2 e{std::cos(third), std::sin(third)};
  MeshProblem problem =
      ModelMaker()
          .loop({make_segment({1, 0}, {2, 0}), make_arc({0, 0}, 2, 0, third),
                 make_segment({2 * e.x, 2 * e.y}, {e.x, e.y}), make_arc({0, 0}, 1, third, 0)},
                "", {"first", "outer", "last", "inner"})
          .problem(0.12);
  problem.periodic = {{"first", "last", {{}, third}, "p"}};
  const MeshResult r = mesh(problem, "DBCO");
  EXPECT_TRUE(r.mesh.triangles.empty());
  expect_images(r.mesh, "first", "last");
}

/// The part of a torus of radii 2 and 0.7 from angle 0 on, open at both ends.
TriangleModel torus_sector(double angle, int along) {
  constexpr int kAround = 40;
  Mesh mesh;
  for (int j = 0; j <= along; ++j)
    for (int i = 0; i < kAround; ++i) {
      const double u = angle * j / along, v = 2 * std::numbers::pi * i / kAround, r = 2 + 0.7 * std::cos(v);
      mesh.points.push_back({r * std::cos(u), r * std::sin(u), 0.7 * std::sin(v)});
    }
  for (int j = 0; j < along; ++j)
    for (int i = 0; i < kAround; ++i) {
      const int a = j * kAround + i, b = j * kAround + (i + 1) % kAround;
      mesh.triangles.push_back({a, b + kAround, b});
      mesh.triangles.push_back({a, a + kAround, b + kAround});
    }
  mesh.regions.push_back({1, {}});
  mesh.triangle_region.assign(mesh.triangles.size(), 0);
  return {mesh};
}

TEST(Periodic, SurfacesMatch) {
  const double angle = 0.5 * std::numbers::pi;
  MeshProblem problem = problem_of(torus_sector(angle, 30), 0.31);
  problem.periodic = {{"curve_1", "curve_2", {{}, angle}, "p"}};
  const MeshResult r = mesh(problem, "DBCO");
  EXPECT_TRUE(r.mesh.triangles.empty());
  ASSERT_EQ(r.mesh.periodic.size(), 1u);
  std::set<int> images, masters;
  for (const auto& [node, master] : r.mesh.periodic[0].nodes) {
    EXPECT_LT(norm(r.mesh.periodic[0].motion(r.mesh.points[master]) - r.mesh.points[node]), 1e-14);
    images.insert(node), masters.insert(master);
  }
  for (std::size_t l = 0; l < r.mesh.lines.size(); ++l)
    for (const int v : r.mesh.lines[l]) {
      const double x = r.mesh.points[v].x, y = r.mesh.points[v].y;
      EXPECT_EQ(std::abs(y) < 1e-9, masters.contains(v));
      EXPECT_EQ(std::abs(x) < 1e-9, images.contains(v));
    }
  EXPECT_EQ(images.size(), masters.size());
  EXPECT_GT(images.size(), 10u);
  problem.periodic[0].motion.angle = 1.5;
  expect_refused(problem, "DBCO",
                 {"p: the sides do not match: the image of (", "away from the curves of 'curve_2'"});
}

TEST(Periodic, IsWritten) {
  const TemporaryFolder folder;
  const MeshResult r = mesh(cell_problem(unit_cell(), 0.1), "DBCO");
  write_mesh(folder / "cell.msh", r.mesh);
  const std::string text = read_text(folder / "cell.msh");
  EXPECT_TRUE(holds(text, "$Periodic\n3\n1 2 8\n16 1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1\n", "$EndPeriodic"));
  write_mesh(folder / "cell.inp", r.mesh);
  const std::string inp = read_text(folder / "cell.inp");
  EXPECT_TRUE(holds(inp, "*NSET, NSET=PERIODIC_3_MASTER\n"));
  EXPECT_EQ(inp.find("UNSORTED"), std::string::npos);  // which CalculiX refuses
  for (std::size_t i = 0; i < r.mesh.periodic.size(); ++i)
    for (const auto& [node, master] : r.mesh.periodic[i].nodes)
      EXPECT_TRUE(holds(inp, "** PERIODIC_" + std::to_string(i + 1) + ": " + std::to_string(node + 1) + ", " +
                                 std::to_string(master + 1) + '\n'));
  EXPECT_EQ(read_mesh(folder / "cell.msh").quads, r.mesh.quads);
}

TEST(Periodic, SidesThatDoNotMatchAreRefused) {
  const auto refused = [](const PeriodicPair& pair, std::initializer_list<const char*> says) {
    MeshProblem problem = cell_problem(unit_cell(), 0.1);
    problem.periodic = {pair};
    expect_refused(problem, "DBCO", says);
  };
  refused({"left", "right", {{0.9, 0, 0}}, "p 1"},
          {"p 1: the sides do not match", "has no image in 'right'"});
  refused({"left", "rihgt", {{1, 0, 0}}, "p 1"}, {"p 1: no curve is called 'rihgt'; did you mean 'right'?"});
  refused({"pore", "hole", {{1, 0, 0}}, "p 1"}, {"p 1: the sides do not match"});
  MeshProblem divided = cell_problem(unit_cell(), 0.1);
  divided.divisions = {{"top", 8, 1, 1, "d 1"}};
  expect_refused(divided, "DBCO", {"p 2: curve", "gets its nodes twice"});
  divided.divisions = {{"bottom", 9, 1.1, 1, "d 1"}};
  const MeshResult r = mesh(divided, "DBCO");
  EXPECT_EQ(nodes_named(r.mesh, "top").size(), 10u);
  expect_images(r.mesh, "bottom", "top");
}

}  // namespace
}  // namespace delquad
