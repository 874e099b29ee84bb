// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/algorithms/stages.h"

/// Loops that edit a mesh end, after work that is linear in it, whatever the mesh is like.
namespace delquad {
namespace {

/// Uniform between two values, in the logarithm.
double log_uniform(std::mt19937_64& random, double low, double high) {
  return low * std::pow(high / low, shapes::uniform(random));
}

/// A square of side 10 with slits from its lower side, down to 1e-9 wide.
std::vector<Vec2> slits(std::mt19937_64& random) {
  std::vector<Vec2> corners = {{0, 0}};
  const int n = 1 + static_cast<int>(random() % 6);
  for (int i = 0; i < n; ++i) {
    const double x = 10 * (i + 0.2 + 0.6 * shapes::uniform(random)) / n, y = 9 * shapes::uniform(random);
    const double half = log_uniform(random, 1e-9, 0.1);
    for (const Vec2 p : {Vec2{x - half, 0}, Vec2{x - half, y}, Vec2{x + half, y}, Vec2{x + half, 0}})
      corners.push_back(p);
  }
  corners.insert(corners.end(), {{10, 0}, {10, 10}, {0, 10}});
  return corners;
}

/// A square of side 10 with needles into it and out of it, down to 1e-9 wide.
std::vector<Vec2> needles(std::mt19937_64& random) {
  std::vector<Vec2> corners = {{0, 0}};
  const int n = 1 + static_cast<int>(random() % 6);
  for (int i = 0; i < n; ++i) {
    const double x = 10 * (i + 0.5) / n, half = log_uniform(random, 1e-9, 0.5);
    const double tip = x + 4.0 / n * (shapes::uniform(random) - 0.5);
    for (const Vec2 p : {Vec2{x - half, 0}, Vec2{tip, 16 * shapes::uniform(random) - 8}, Vec2{x + half, 0}})
      corners.push_back(p);
  }
  corners.insert(corners.end(), {{10, 0}, {10, 10}, {0, 10}});
  return corners;
}

/// A triangle or a quadrilateral down to 1e-6 thick.
std::vector<Vec2> slivers(std::mt19937_64& random) {
  const double thick = log_uniform(random, 1e-6, 1), x = 10 * shapes::uniform(random);
  if (random() % 2 == 0) return {{0, 0}, {10, 0}, {x, thick}};
  return {{0, 0}, {10, 0}, {10 - thick, thick}, {x / 2, thick / (1 + 4 * shapes::uniform(random))}};
}

/// Its sides cut into edges of about the size; some much longer or shorter. Even in number.
PatchBoundary boundary_of(const std::vector<Vec2>& corners, double size, std::mt19937_64& random) {
  std::vector<int> per_side;
  int total = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const double edge = random() % 4 == 0 ? log_uniform(random, size / 8, 8 * size) : size;
    const double length = norm(corners[(i + 1) % corners.size()] - corners[i]);
    per_side.push_back(std::max(1, static_cast<int>(std::lround(length / edge))));
    total += per_side.back();
  }
  per_side.back() += total % 2;
  PatchBoundary boundary;
  shapes::add_polygon(boundary, corners, per_side);
  return boundary;
}

/// Elements looked at per element of the raw mesh. Ordinary patches take some hundreds. Patches of which
/// every quad is bad take up to 22 000: each tries a dozen moves and is remeshed within its budget.
constexpr double kMostLooks = 30000;

void expect_linear_work(const QuadPatch& raw, const ParametricSize& size, const std::string& what) {
  const double n = static_cast<double>(raw.quads.size()) + 20;
  TreatmentSummary treatment;
  const QuadPatch treated = treat_paper(raw, size, {}, &treatment);
  EXPECT_LT(static_cast<double>(treatment.looks), kMostLooks * n) << what;
  EXPECT_LT(static_cast<double>(treated.quads.size()), 6 * n) << what;
  RegularitySummary cleanup;
  const QuadPatch cleaned = make_regular(treated, size, without_price({}), &cleanup);
  EXPECT_LT(static_cast<double>(cleanup.looks), kMostLooks * n) << what;
  EXPECT_LT(static_cast<double>(cleaned.quads.size()), 6 * n) << what;
  for (const QuadPatch* mesh : {&treated, &cleaned}) {
    RegularitySummary regularity;
    const QuadPatch regular = make_regular(*mesh, size, {}, &regularity);
    EXPECT_LT(static_cast<double>(regularity.looks), kMostLooks * n) << what;
    EXPECT_LT(static_cast<double>(regular.quads.size()), 6 * n) << what;
    EXPECT_LE(regularity.irregular_after, regularity.irregular_before) << what;
    EXPECT_GE(worst_sine(regular), std::min(worst_sine(*mesh), sine_of_eta(kFloorEta))) << what;
  }
}

struct Seeds {
  int begin, end;
};
constexpr Seeds kFew{0, 5}, kMore{5, 24};  // more: `make test-long`

void mesh_random_patches(const char* name, Seeds seeds,
                         const std::function<std::vector<Vec2>(std::mt19937_64&)>& make) {
  for (int seed = seeds.begin; seed < seeds.end; ++seed) {
    std::mt19937_64 random(seed);
    const std::vector<Vec2> corners = make(random);
    const double size = log_uniform(random, 0.2, 3);
    const PatchBoundary boundary = boundary_of(corners, size, random);
    const FunctionSize delta(size);
    const auto placement = seed % 2 == 0 ? make_linf_delquad() : make_l2_frontal();
    expect_linear_work(matched(boundary, delta, FunctionCross(0.3), *placement), delta,
                       std::string(name) + " " + std::to_string(seed));
  }
}

TEST(Termination, Slits) { mesh_random_patches("slits", kFew, slits); }
TEST(Termination, Needles) { mesh_random_patches("needles", kFew, needles); }
TEST(Termination, Slivers) { mesh_random_patches("slivers", kFew, slivers); }
TEST(TerminationLong, Slits) { mesh_random_patches("slits", kMore, slits); }
TEST(TerminationLong, Needles) { mesh_random_patches("needles", kMore, needles); }
TEST(TerminationLong, Slivers) { mesh_random_patches("slivers", kMore, slivers); }

/// The greater the seed, the more tangled.
void tangle_grid(int seed) {
  const QuadPatch mesh = jittered(scrambled(grid_patch(16, 16), seed, 400), seed, 0.1 * seed);
  expect_linear_work(mesh, FunctionSize(1), "grid " + std::to_string(seed));
}

TEST(Termination, TangledGrids) {
  for (const int seed : {0, 7, 19}) tangle_grid(seed);
}
TEST(TerminationLong, TangledGrids) {
  for (int seed = 1; seed < 19; ++seed) tangle_grid(seed);
}

/// A disc of n quads, all around one vertex.
QuadPatch wheel(int n) {
  QuadPatch mesh;
  mesh.n_boundary = 2 * n;
  for (int i = 0; i < 2 * n; ++i) {
    const double angle = std::numbers::pi * i / n;
    mesh.points.push_back({std::cos(angle), std::sin(angle)});
  }
  mesh.points.push_back({0, 0});
  for (int i = 0; i < 2 * n; i += 2) mesh.quads.push_back({2 * n, i, i + 1, (i + 2) % (2 * n)});
  return mesh;
}

TEST(Termination, VerticesOfManyQuads) {
  for (const int n : {40, 100}) expect_linear_work(wheel(n), FunctionSize(0.3), std::to_string(n));
}
TEST(TerminationLong, VerticesOfManyQuads) {
  for (const int n : {200, 1000}) expect_linear_work(wheel(n), FunctionSize(0.3), std::to_string(n));
}

}  // namespace
}  // namespace delquad
