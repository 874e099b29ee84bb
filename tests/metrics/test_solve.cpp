// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/solve/solve.h"
#include "metrics/solve/solver_metrics.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

#include "tests/metrics/solver_reference.inc"

/// Inner nodes of a grid of nx x ny cells moved along a smooth field: affine cells no more.
void bend(Mesh& mesh, int nx, int ny) {
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) {
      Vec3& p = mesh.points[static_cast<std::size_t>(j * (nx + 1) + i)];
      const double bump = std::sin(std::numbers::pi * i / nx) * std::sin(std::numbers::pi * j / ny);
      p = p + Vec3{0.1 * bump * std::sin(5 * p.x + 3 * p.y), 0.1 * bump * std::cos(4 * p.x - p.y), 0};
    }
}

Mesh bent_grid(int nx, int ny, double width = 1, double height = 1) {
  Mesh mesh = quad_grid(nx, ny, width, height);
  bend(mesh, nx, ny);
  return mesh;
}

/// Inner nodes moved by up to a fifth of a side to all sides, whatever the size: cells never get affine.
Mesh shaken_grid(int n) {
  Mesh mesh = quad_grid(n, n);
  for (int j = 1; j < n; ++j)
    for (int i = 1; i < n; ++i) {
      Vec3& p = mesh.points[static_cast<std::size_t>(j * (n + 1) + i)];
      p = p +
          Vec3{0.2 / n * std::sin(12.9898 * i + 78.233 * j), 0.2 / n * std::sin(39.346 * i + 11.135 * j), 0};
    }
  return mesh;
}

/// As make_solver_reference.py has it: the first cell is two triangles.
Mesh reference_mesh() {
  Mesh mesh = bent_grid(5, 4, 2, 1);
  const auto [a, b, c, d] = mesh.quads[0];
  mesh.quads.erase(mesh.quads.begin());
  mesh.quad_region.pop_back();
  mesh.triangles = {{a, b, c}, {a, c, d}};
  mesh.triangle_region = {0, 0};
  return mesh;
}

/// A cube's grid blown up to a sphere of radius 1: closed, all quads, warped.
Mesh sphere(int n) {
  Mesh mesh;
  mesh.regions = {{1, {}}};
  std::map<std::array<int, 3>, int> known;
  const auto node = [&](std::array<int, 3> k) {
    const auto [at, is_new] = known.try_emplace(k, static_cast<int>(mesh.points.size()));
    if (is_new) {
      const auto side = [&](int i) { return std::tan(std::numbers::pi / 4 * (2.0 * i / n - 1)); };
      const Vec3 p = {side(k[0]), side(k[1]), side(k[2])};
      mesh.points.push_back((1 / norm(p)) * p);
    }
    return at->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const int end : {0, n})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto at = [&](int u, int v) {
            std::array<int, 3> k;
            k[axis] = end;
            k[(axis + 1) % 3] = u;
            k[(axis + 2) % 3] = v;
            return node(k);
          };
          std::array<int, 4> quad = {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
          if (end == 0) std::swap(quad[1], quad[3]);
          mesh.quads.push_back(quad);
          mesh.quad_region.push_back(0);
        }
  return mesh;
}

Mesh turned(Mesh mesh, double angle, const Vec3& by, double scale) {
  const double c = std::cos(angle), s = std::sin(angle);
  for (Vec3& p : mesh.points) p = scale * Vec3{c * p.x - s * p.y, s * p.x + c * p.y, p.z} + by;
  return mesh;
}

using Solve = std::function<SolverErrors(const Mesh&)>;
SolverErrors poisson(const Mesh& mesh) { return solve_poisson(mesh); }
SolverErrors elasticity(const Mesh& mesh) { return solve_elasticity(mesh); }

/// Error in L2 falls with h^2, in H1 with h.
void expect_orders(const Solve& solve, const std::function<Mesh(int)>& grid, int coarse, double slack) {
  const SolverErrors a = solve(grid(coarse)), b = solve(grid(2 * coarse));
  EXPECT_NEAR(std::log2(a.l2 / b.l2), 2, slack);
  EXPECT_NEAR(std::log2(a.h1 / b.h1), 1, slack);
}

TEST(Solve, ConvergesOnGrids) {
  const auto square = [](int n) { return quad_grid(n, n); };
  const auto bent = [](int n) { return bent_grid(n, n); };
  const auto triangles = [](int n) { return triangle_grid(n, n); };
  for (const Solve& solve : {Solve(poisson), Solve(elasticity)}) {
    expect_orders(solve, square, 16, 0.03);
    expect_orders(solve, bent, 24, 0.06);
    expect_orders(solve, shaken_grid, 24, 0.1);
    expect_orders(solve, triangles, 24, 0.06);
  }
}

TEST(Solve, ConvergesOnASphere) { expect_orders(poisson, sphere, 10, 0.06); }

TEST(Solve, KnowsLinearFieldsExactly) {
  const auto linear = [](const Vec3& x) {
    return ScalarSolution{1 + 2 * x.x - 3 * x.y + x.z, Vec3{2, -3, 1}};
  };
  const auto strain = [](const Vec3& x) {
    return VectorSolution{{0.1 + 0.2 * x.x - 0.3 * x.y, 0.4 * x.x + 0.5 * x.y},
                          {Vec3{0.2, -0.3, 0}, Vec3{0.4, 0.5, 0}}};
  };
  for (const Mesh& mesh : {reference_mesh(), bent_grid(9, 7), triangle_grid(5, 6), shaken_grid(8)}) {
    for (const SolverErrors& e : {solve_poisson(mesh, linear), solve_elasticity(mesh, strain)}) {
      EXPECT_LT(e.l2, 1e-12);
      EXPECT_LT(e.h1, 1e-12);
    }
  }
  // Bilinear quads in space hold linear fields of space, too.
  const SolverErrors e = solve_poisson(sphere(6), linear);
  EXPECT_LT(e.l2, 1e-12);
  EXPECT_LT(e.h1, 1e-12);
}

TEST(Solve, AgreesWithADenseSolver) {
  const auto expect = [](const SolverErrors& ours, const double(&reference)[4]) {
    EXPECT_NEAR(ours.l2 / reference[0], 1, 1e-12);
    EXPECT_NEAR(ours.h1 / reference[1], 1, 1e-12);
    EXPECT_NEAR(ours.condition / reference[2], 1, 2e-3);
    EXPECT_EQ(ours.cg_iterations, reference[3]);
  };
  expect(poisson(reference_mesh()), kPoisson);
  expect(elasticity(reference_mesh()), kElasticity);
}

TEST(Solve, DoesNotSeeHowTheDomainLies) {
  const Mesh mesh = bent_grid(11, 8, 2, 1);
  for (const Solve& solve : {Solve(poisson), Solve(elasticity)}) {
    const SolverErrors straight = solve(mesh);
    for (const double angle : {0.1, 1.0, 2.5}) {
      const SolverErrors other = solve(turned(mesh, angle, {3, -7, 2}, 5));
      EXPECT_NEAR(other.l2 / straight.l2, 1, 1e-10);
      EXPECT_NEAR(other.h1 / straight.h1, 1, 1e-10);
      EXPECT_NEAR(other.condition / straight.condition, 1, 1e-5);
    }
  }
}

/// An n x n grid of squares: eigenvalues of the bilinear stencil are known in closed form.
TEST(Solve, KnowsTheConditionOfAGrid) {
  const int n = 20;
  const auto eigenvalue = [&](int k, int l) {
    const double a = std::cos(std::numbers::pi * k / n), b = std::cos(std::numbers::pi * l / n);
    return (8 - 2 * a - 2 * b - 4 * a * b) / 3;
  };
  double least = 1e300, largest = 0;
  for (int k = 1; k < n; ++k)
    for (int l = 1; l < n; ++l) {
      least = std::min(least, eigenvalue(k, l));
      largest = std::max(largest, eigenvalue(k, l));
    }
  EXPECT_NEAR(poisson(quad_grid(n, n)).condition / (largest / least), 1, 2e-3);
}

/// The second smallest eigenvalue counts where constants are the kernel; two parts have two of them.
TEST(Solve, TreatsClosedPartsUpToAConstant) {
  const Mesh one = sphere(5);
  Mesh two = one;
  const int n = static_cast<int>(one.points.size());
  for (const Vec3& p : one.points) two.points.push_back(p + Vec3{5, 0, 0});
  for (auto quad : one.quads) {
    for (int& i : quad) i += n;
    two.quads.push_back(quad);
    two.quad_region.push_back(0);
  }
  const SolverErrors a = poisson(one), b = poisson(two);
  EXPECT_GT(a.condition, 1);
  EXPECT_NEAR(b.condition / a.condition, 1, 1e-5);
}

TEST(Solve, RefusesWhatHasNoSolution) {
  const auto expect = [](const Mesh& mesh, const std::string& part) {
    expect_input_error([&] { solve_poisson(mesh); }, {part.c_str()});
    expect_input_error([&] { solve_elasticity(mesh); }, {part.c_str()});
    const SolverOutcome outcome = measure_by_solver(mesh, "poisson");
    EXPECT_TRUE(holds(outcome.undefined, part));
    for (const auto& [key, value] : outcome.values) EXPECT_TRUE(std::isnan(value)) << key;
  };
  expect(Mesh{}, "no elements");
  expect(quad_grid(1, 1), "all nodes are on the boundary");
  Mesh inverted = quad_grid(4, 4);
  inverted.points[6] = {0.9, 0.9, 0};
  expect(inverted, "quads and 0 of 0 triangles are inverted or degenerate");
  Mesh flat = quad_grid(4, 4);
  flat.points[6] = flat.points[7];
  expect(flat, "inverted or degenerate");
  Mesh triangles = triangle_grid(4, 4);
  triangles.points[6] = triangles.points[7];
  expect(triangles, "of 32 triangles are inverted or degenerate");
  expect_input_error([] { solve_elasticity(sphere(4)); }, {"elasticity needs a planar mesh"});
}

TEST(SolverMetrics, AreNamed) {
  for (const std::string& solver : solver_names()) {
    const SolverOutcome outcome = measure_by_solver(bent_grid(6, 6), solver);
    EXPECT_EQ(outcome.undefined, "");
    EXPECT_EQ(outcome.values.size(), metrics_of_solver(solver).size());
    for (const Metric& metric : metrics_of_solver(solver)) {
      EXPECT_GT(outcome.values.at(metric.key), 0) << metric.key;
      EXPECT_EQ(find_metric(metric.key), nullptr) << "others have it, too";
    }
  }
  expect_input_error([] { measure_by_solver(quad_grid(2, 2), "poison"); }, {"did you mean 'poisson'"});
}

}  // namespace
}  // namespace delquad
