// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/insertion/frontal_mesher.h"
#include "features/curves/mesh_surface_curves.h"
#include "geometry/patches/surface_domain.h"
#include "geometry/surface/improve_triangulation.h"
#include "smoothing/cvt/smooth_points.h"
#include "tests/smoothing/seeds.h"

namespace delquad {
namespace {

struct Smoothed {
  TriPatch patch;
  SmoothingSummary summary;
};

Smoothed smooth(const PatchBoundary& boundary, const std::vector<Vec2>& seeds, const CrossField& cross,
                const ParametricSize& size, const SmoothingOptions& options = {}) {
  Smoothed result;
  result.patch = smooth_points(constrained_delaunay(boundary, seeds), cross, size, options, &result.summary);
  return result;
}

/// A frontal mesh of equilateral triangles, which has much to gain.
TriPatch frontal(const PatchBoundary& boundary, const CrossField& cross, const ParametricSize& size) {
  return mesh_frontal(boundary, *make_l2_frontal(), cross, size);
}

/// The boundary is where it was, and all triangles stand upright and are Delaunay up to rounding.
void expect_sound(const TriPatch& patch, const PatchBoundary& boundary, std::size_t n_points) {
  EXPECT_EQ(patch.points.size(), n_points);
  EXPECT_TRUE(std::equal(boundary.points.begin(), boundary.points.end(), patch.points.begin()));
  EXPECT_TRUE(check_invariants(patch).empty());
  std::set<std::array<int, 2>> free, expected(boundary.edges.begin(), boundary.edges.end());
  for (std::size_t t = 0; t < patch.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const auto& v = patch.triangles[t];
      if (patch.neighbours[t][k] < 0) free.insert({v[(k + 1) % 3], v[(k + 2) % 3]});
      for (const int other : patch.neighbours[t])
        for (int m = 0; other >= 0 && m < 3; ++m)
          EXPECT_LE(in_circle_filtered(patch.points[v[0]], patch.points[v[1]], patch.points[v[2]],
                                       patch.points[patch.triangles[other][m]]),
                    0);
    }
  EXPECT_EQ(free, expected);
}

/// Among the samples of one set of frames, each accepted one is at most as high as the one before.
void expect_descent(const SmoothingSummary& summary) {
  double last = INFINITY;
  int frames = -1;
  for (const EnergySample& s : summary.samples) {
    if (s.frames != frames) last = INFINITY;
    frames = s.frames;
    if (!s.accepted) continue;
    EXPECT_LE(s.energy, last);
    last = s.energy;
  }
}

TEST(Smoothing, LowersTheEnergyAndKeepsEveryPoint) {
  for (const std::uint64_t seed : {3, 5, 9}) {
    const PatchBoundary boundary = shapes::random_polygon_with_holes(seed, 0.06);
    const FunctionCross cross([](Vec2 x) { return 0.5 * x.x + 0.3; });
    const FunctionSize size([](Vec2 x) { return 0.06 * (1 + 0.4 * x.y); });
    for (const int p : {2, 4, 6, 16}) {
      SmoothingOptions options;
      options.p = p;
      const TriPatch before = frontal(boundary, cross, size);
      const Smoothed after = smooth(boundary, inner_points(before), cross, size, options);
      expect_sound(after.patch, boundary, before.points.size());
      expect_descent(after.summary);
      EXPECT_LT(after.summary.final_energy, after.summary.first_energy);
      EXPECT_GT(after.summary.iterations, 5);
      EXPECT_EQ(after.summary.evaluations, static_cast<int>(after.summary.samples.size()));
    }
  }
}

/// Where disturbed points of the square lattice end, and how far the farthest is from its place, in spacings.
std::pair<SmoothingSummary, double> disturbed_lattice(int p) {
  const int n = 12;
  std::mt19937_64 random(1);
  std::vector<Vec2> lattice, seeds;
  for (int j = 1; j < n; ++j)
    for (int i = 1; i < n; ++i) {
      lattice.push_back({double(i) / n, double(j) / n});
      seeds.push_back(lattice.back() +
                      (0.3 / n) * Vec2{shapes::uniform(random) - 0.5, shapes::uniform(random) - 0.5});
    }
  SmoothingOptions options;
  options.p = p;
  options.inner.iterations = 200;
  options.inner.function_tolerance = 0;
  options.inner.gradient_tolerance = 1e-9;
  const Smoothed result =
      smooth(shapes::rectangle(1, 1, n, n), seeds, FunctionCross(0), FunctionSize(1.0 / n), options);
  const std::vector<Vec2> found = inner_points(result.patch);
  double farthest = 0;
  for (std::size_t i = 0; i < lattice.size(); ++i)
    farthest = std::max(farthest, n * norm(found[i] - lattice[i]));
  return {result.summary, farthest};
}

TEST(Smoothing, BringsPointsBackToTheLattice) {
  for (const int p : {6, 8, 16}) {
    const auto [summary, farthest] = disturbed_lattice(p);
    EXPECT_EQ(summary.termination, SmoothingTermination::kConverged);
    EXPECT_LE(summary.gradient_norm, 1e-8);
    EXPECT_NEAR(summary.final_energy, 1, 1e-12);
    EXPECT_LE(farthest, 1e-6) << p;
  }
}

TEST(Smoothing, LatticeIsASaddleForSmallNorms) {
  // Why 6 is the default.
  for (const int p : {2, 4}) {
    const auto [summary, farthest] = disturbed_lattice(p);
    EXPECT_LT(summary.final_energy, 1 - 1e-5) << p;
    EXPECT_GT(farthest, 0.01) << p;
  }
}

TEST(Smoothing, LatticeStaysWhereItIs) {
  const int n = 10;
  std::vector<Vec2> seeds;
  for (int j = 1; j < n; ++j)
    for (int i = 1; i < n; ++i) seeds.push_back({double(i) / n, double(j) / n});
  const Smoothed result =
      smooth(shapes::rectangle(1, 1, n, n), seeds, FunctionCross(0), FunctionSize(1.0 / n));
  EXPECT_EQ(result.summary.termination, SmoothingTermination::kConverged);
  EXPECT_NEAR(result.summary.first_energy, 1, 1e-12);
  const std::vector<Vec2> found = inner_points(result.patch);
  for (std::size_t i = 0; i < seeds.size(); ++i) EXPECT_LE(norm(found[i] - seeds[i]), 1e-12);
}

TEST(Smoothing, SizesFollowTheSizeField) {
  // Columns of a strip between two fixed ends: their widths come out in proportion to delta.
  const double delta_left = 0.02, delta_right = 0.06;
  const FunctionSize size([&](Vec2 x) { return delta_left + (delta_right - delta_left) * x.x; });
  const FunctionCross cross(0.0);
  PatchBoundary box;
  std::vector<Vec2> points;
  const auto graded = [&](int n) {  // equal integrals of dx / delta
    std::vector<double> x;
    for (int i = 0; i < n; ++i)
      x.push_back((delta_left * std::pow(delta_right / delta_left, double(i) / n) - delta_left) /
                  (delta_right - delta_left));
    return x;
  };
  for (const double x : graded(28)) points.push_back({x, 0});
  for (int j = 0; j < 16; ++j) points.push_back({1, j / 16.0});
  std::vector<double> top = graded(28);
  points.push_back({1, 1});
  for (int i = 27; i > 0; --i) points.push_back({top[i], 1});
  for (int j = 50; j > 0; --j) points.push_back({0, j / 50.0});
  shapes::add_loop(box, points, std::vector<int>(points.size(), 0));
  const TriPatch before = frontal(box, cross, size);
  // Triangles at the left and at the right: mean of area / delta^2.
  const auto mean_ratio = [&](const Smoothed& after, double low, double high) {
    double sum = 0;
    int n = 0, hint = -1;
    for (const auto& v : after.patch.triangles) {
      const Vec2 a = after.patch.points[v[0]], b = after.patch.points[v[1]], c = after.patch.points[v[2]];
      const Vec2 middle = (1.0 / 3) * (a + b + c);
      if (middle.x < low || middle.x > high || middle.y < 0.15 || middle.y > 0.85) continue;
      sum += delquad::cross(b - a, c - a) / std::pow(size.at(middle, hint), 2);
      ++n;
    }
    return sum / n;
  };
  for (const auto& [outer, inner] : {std::pair{20, 15}, std::pair{4, 300}}) {
    SmoothingOptions options;
    options.outer_iterations = outer;
    options.inner.iterations = inner;
    options.inner.function_tolerance = 0;
    const Smoothed after = smooth(box, inner_points(before), cross, size, options);
    EXPECT_NEAR(mean_ratio(after, 0.1, 0.4) / mean_ratio(after, 0.6, 0.9), 1, 0.04);
  }
}

TEST(Smoothing, MovesWithTheProblem) {
  const PatchBoundary boundary = shapes::random_polygon_with_holes(9, 0.12);
  const std::vector<Vec2> seeds = random_seeds(boundary, 9, 300, 0.08);
  const double angle = 0.6, scale = 40;
  const Vec2 shift{100, -30};
  const auto moved = [&](Vec2 v) {
    return shift + scale * Vec2{std::cos(angle) * v.x - std::sin(angle) * v.y,
                                std::sin(angle) * v.x + std::cos(angle) * v.y};
  };
  const auto back = [&](Vec2 v) {
    const Vec2 w = (1 / scale) * (v - shift);
    return Vec2{std::cos(angle) * w.x + std::sin(angle) * w.y,
                -std::sin(angle) * w.x + std::cos(angle) * w.y};
  };
  const auto theta = [](Vec2 x) { return 0.4 * x.x; };
  const auto delta = [](Vec2 x) { return 0.1 + 0.02 * x.y; };
  PatchBoundary boundary2 = boundary;
  std::vector<Vec2> seeds2 = seeds;
  for (Vec2& x : boundary2.points) x = moved(x);
  for (Vec2& x : seeds2) x = moved(x);
  SmoothingOptions options;
  options.outer_iterations = 2;
  options.inner.iterations = 6;  // rounding grows from step to step
  const Smoothed one = smooth(boundary, seeds, FunctionCross(theta), FunctionSize(delta), options);
  const Smoothed two =
      smooth(boundary2, seeds2, FunctionCross([&](Vec2 x) { return theta(back(x)) + angle; }),
             FunctionSize([&](Vec2 x) { return scale * delta(back(x)); }), options);
  EXPECT_NEAR(one.summary.final_energy, two.summary.final_energy, 1e-9);
  for (std::size_t i = 0; i < one.patch.points.size(); ++i)
    EXPECT_LE(norm(two.patch.points[i] - moved(one.patch.points[i])), 1e-7 * scale) << i;
}

TEST(Smoothing, IsTheSameBytesOnAnyNumberOfThreads) {
  const PatchBoundary boundary = shapes::annulus(0.4, 1, 60, 150);
  const FunctionCross cross([](Vec2 x) { return std::atan2(x.y, x.x); });
  const FunctionSize size(0.02);
  const std::vector<Vec2> seeds = inner_points(frontal(boundary, cross, size));
  ASSERT_GT(seeds.size(), 5000u);  // several blocks
  on_threads({1, 2, 3, 7}, [&] {
    const TriPatch patch = smooth(boundary, seeds, cross, size).patch;
    return std::pair(patch.points, patch.triangles);
  });
}

TEST(Smoothing, WorksInTheParameterPlaneOfASurface) {
  SurfaceModel model = bump(24, 0.4);
  improve_triangulation(model);
  const SurfaceSize size(make_constant_size(0.08));
  Flattening flattening = flatten(model);
  const SurfaceDomain domain =
      make_surface_domain(model, std::move(flattening), size, *make_primal_dual_solver());
  for (const SurfacePatch& patch : domain.patches) {
    const HarmonicCrossField cross(patch.background);
    const SurfacePatchSize delta(patch, model.fine, size);
    const TriPatch before = frontal(patch.boundary, cross, delta);
    std::vector<Vec2> seeds = inner_points(before);
    for (const int p : {2, 4, 6, 8}) {
      CvtProblem problem(MovingDelaunay(before), p);
      problem.hold_frames(cross, delta);
      ASSERT_TRUE(problem.evaluate(seeds));
      const std::vector<Vec2> gradient(problem.gradient().begin(), problem.gradient().end());
      double largest = 0;
      for (const Vec2 g : gradient) largest = std::max(largest, norm(g));
      for (std::size_t i = 0; i < seeds.size(); i += 5)
        for (double Vec2::*along : {&Vec2::x, &Vec2::y})
          EXPECT_NEAR(slope_of(seeds[i].*along, 1e-6, [&] { return *problem.evaluate(seeds); }),
                      gradient[i].*along, 1e-6 * largest)
              << p;
    }
    const Smoothed after = smooth(patch.boundary, seeds, cross, delta);
    expect_sound(after.patch, patch.boundary, before.points.size());
    EXPECT_LT(after.summary.final_energy, after.summary.first_energy);
  }
}

TEST(BadSmoothing, OptionsOutOfRange) {
  const PatchBoundary boundary = shapes::rectangle(1, 1, 4, 4);
  const auto with = [&](auto change) {
    SmoothingOptions options;
    change(options);
    smooth(boundary, {{0.5, 0.5}}, FunctionCross(0), FunctionSize(0.25), options);
  };
  expect_input_error([&] { with([](SmoothingOptions& o) { o.p = 5; }); }, {"p is 5", "even", "2 to 16"});
  expect_input_error([&] { with([](SmoothingOptions& o) { o.p = 18; }); }, {"p is 18"});
  expect_input_error([&] { with([](SmoothingOptions& o) { o.inner.iterations = -1; }); },
                     {"inner_iterations is -1"});
  expect_input_error([&] { with([](SmoothingOptions& o) { o.inner.function_tolerance = NAN; }); },
                     {"function_tolerance is nan"});
}

TEST(BadSmoothing, WithoutIterationsPointsStay) {
  const PatchBoundary boundary = shapes::rectangle(1, 1, 6, 6);
  const std::vector<Vec2> seeds = {{0.3, 0.4}, {0.7, 0.6}, {0.5, 0.5}};
  for (const bool outer : {true, false}) {
    SmoothingOptions options;
    (outer ? options.outer_iterations : options.inner.iterations) = 0;
    const Smoothed result = smooth(boundary, seeds, FunctionCross(0), FunctionSize(0.2), options);
    EXPECT_EQ(inner_points(result.patch), seeds);
    EXPECT_EQ(result.summary.termination, SmoothingTermination::kIterations);
    EXPECT_EQ(result.summary.iterations, 0);
    EXPECT_EQ(result.summary.evaluations, 1);
    EXPECT_EQ(result.summary.final_energy, result.summary.first_energy);
  }
}

TEST(BadSmoothing, SeedsOutsideOrCoincidentAreNamed) {
  const PatchBoundary boundary = shapes::rectangle(1, 1, 4, 4);
  const auto with = [&](const std::vector<Vec2>& seeds) {
    smooth(boundary, seeds, FunctionCross(0), FunctionSize(0.25));
  };
  expect_input_error([&] { with({{2, 0.5}}); }, {"(2, 0.5)", "outside"});
  expect_input_error([&] { with({{0.4, 0.5}, {0.4, 0.5}}); }, {"coincide", "(0.4, 0.5)"});
  expect_input_error([&] { with({{0.25, 0}}); }, {"coincide"});
}

TEST(BadSmoothing, ZeroWidthNeckIsNamed) {
  // Two squares that touch in a point.
  const PatchBoundary boundary = shapes::polygon(
      {{-1, -1}, {-0.5, -1}, {0, 0}, {0.5, -1}, {1, -1}, {1, 1}, {0.5, 1}, {0, 0}, {-0.5, 1}, {-1, 1}});
  expect_input_error([&] { smooth(boundary, {}, FunctionCross(0), FunctionSize(0.5)); },
                     {"coincide", "(0, 0)"});
}

TEST(BadSmoothing, SingularityOnASeedIsDefined) {
  // The field has no direction at the seed in the middle.
  class Singular final : public CrossField {
   public:
    Cross at(Vec2 u, int&) const override { return {u.x, u.y}; }
  };
  const PatchBoundary boundary = shapes::disk(1, 40);
  std::vector<Vec2> seeds = random_seeds(boundary, 4, 300, 0.12);
  std::erase_if(seeds, [](Vec2 x) { return norm(x) < 0.1; });
  seeds.push_back({0, 0});
  const Smoothed result = smooth(boundary, seeds, Singular(), FunctionSize(0.15));
  expect_sound(result.patch, boundary, boundary.points.size() + seeds.size());
  EXPECT_LT(result.summary.final_energy, result.summary.first_energy);
}

TEST(BadSmoothing, WithoutFreePointsNothingMoves) {
  const PatchBoundary boundary = shapes::rectangle(1, 1, 2, 2);
  const Smoothed result = smooth(boundary, {}, FunctionCross(0), FunctionSize(0.5));
  expect_sound(result.patch, boundary, 8);
  EXPECT_EQ(result.summary.termination, SmoothingTermination::kConverged);
  EXPECT_EQ(result.summary.iterations, 0);
  EXPECT_GT(result.summary.first_energy, 0);
}

TEST(BadSmoothing, SliversAndSharpCornersStayInside) {
  const PatchBoundary boundary =
      shapes::polygon({{-1, 0}, {1, -0.02}, {1, 0.02}, {-0.9, 0.3}, {-0.95, 0.05}}, 8);
  const std::vector<Vec2> seeds = random_seeds(boundary, 2, 3000, 0.01);
  ASSERT_GT(seeds.size(), 30u);
  const Smoothed result = smooth(boundary, seeds, FunctionCross(0), FunctionSize(0.05));
  expect_sound(result.patch, boundary, boundary.points.size() + seeds.size());
  EXPECT_LT(result.summary.final_energy, result.summary.first_energy);
}

}  // namespace
}  // namespace delquad
