// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <benchmark/benchmark.h>

#include <cmath>

#include "algorithms/insertion/frontal_mesher.h"
#include "base/context.h"
#include "benchmarks/square_case.h"
#include "smoothing/cvt/moving_delaunay.h"
#include "smoothing/cvt/smooth_points.h"

// Times energy and gradient of Lp-CVT smoothing with the repair of the triangulation, whole runs, and CGAL's
// spatially sorted Delaunay triangulation of the same points.

namespace delquad::benchmarks {
namespace {

/// Points of F on the unit square, about as many as requested.
struct Seeds {
  explicit Seeds(double n)
      : square(Grading::kUniform, 2 * n / 1.15),  // F inserts 1.15 points for each square
        mesh(mesh_frontal(square.boundary(), *make_l2_frontal(), square.cross, square.size)) {}
  SquareCase square;
  TriPatch mesh;
};

/// Times one evaluation; the second argument is the number of threads. The seeds move back and forth as in
/// the first steps of a run, so the triangulation has flips.
void evaluate(benchmark::State& state) {
  const Seeds seeds(static_cast<double>(state.range(0)));
  const RunScope run({.threads = static_cast<int>(state.range(1))});
  CvtProblem problem(MovingDelaunay(reordered(seeds.mesh, spatial_order(seeds.mesh))), SmoothingOptions().p);
  problem.hold_frames(seeds.square.cross, seeds.square.size);
  const std::vector<Vec2> here = problem.seeds();
  problem.evaluate(here);
  std::vector<Vec2> there = here;
  for (std::size_t i = 0; i < there.size(); ++i)
    there[i] += -problem.newton_scale() * std::pow(problem.lengths()[i], 2) * problem.gradient()[i];
  const long long flips = problem.delaunay().flips();
  bool forth = false;
  for (auto _ : state) benchmark::DoNotOptimize(problem.evaluate((forth = !forth) ? there : here));
  state.counters["points"] = problem.delaunay().n_points();
  state.counters["flips"] = benchmark::Counter(static_cast<double>(problem.delaunay().flips() - flips),
                                               benchmark::Counter::kAvgIterations);
  state.counters["rebuilds"] = problem.delaunay().rebuilds();
  state.SetComplexityN(problem.delaunay().n_points());
}

void triangulation_alone(benchmark::State& state) {
  using Delaunay = CGAL::Delaunay_triangulation_2<CGAL::Exact_predicates_inexact_constructions_kernel>;
  const Seeds seeds(static_cast<double>(state.range(0)));
  std::vector<Delaunay::Point> points;
  for (const Vec2 p : seeds.mesh.points) points.emplace_back(p.x, p.y);
  for (auto _ : state) {
    Delaunay delaunay;
    delaunay.insert(points.begin(), points.end());
    benchmark::DoNotOptimize(delaunay.number_of_vertices());
  }
  state.SetComplexityN(static_cast<benchmark::IterationCount>(points.size()));
}

void report(benchmark::State& state, const SmoothingSummary& s) {
  state.counters["points"] = s.cells;
  state.counters["evaluations"] = s.evaluations;
  state.counters["first_energy"] = s.first_energy;
  state.counters["final_energy"] = s.final_energy;
  state.counters["rebuilds"] = s.rebuilds;
}

/// Times stage L with its defaults; the second argument is the number of threads.
void solve(benchmark::State& state) {
  const Seeds seeds(static_cast<double>(state.range(0)));
  const RunScope run({.threads = static_cast<int>(state.range(1))});
  SmoothingSummary summary;
  for (auto _ : state) smooth_points(seeds.mesh, seeds.square.cross, seeds.square.size, {}, &summary);
  report(state, summary);
}

void sizes(benchmark::internal::Benchmark* b) {
  for (const int n : {1000, 10000, 50000, 100000, 1000000}) b->Args({n, 1});
  b->Unit(benchmark::kMillisecond)->UseRealTime()->Complexity();
}
BENCHMARK(evaluate)->Apply(sizes);
BENCHMARK(evaluate)
    ->Name("evaluate_2_threads")
    ->Args({50000, 2})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(triangulation_alone)->Apply(sizes);
BENCHMARK(solve)->ArgsProduct({{1000, 10000, 50000}, {1, 2}})->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace delquad::benchmarks
