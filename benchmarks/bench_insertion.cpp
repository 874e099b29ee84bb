// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <benchmark/benchmark.h>

#include "algorithms/insertion/frontal_mesher.h"
#include "base/context.h"
#include "benchmarks/square_case.h"

// Times insertion by F and D, and CGAL's spatially sorted Delaunay triangulation of the points of each.

namespace delquad::benchmarks {
namespace {

std::unique_ptr<PointPlacement> strategy(char letter) {
  return letter == 'F' ? make_l2_frontal() : make_linf_delquad();
}

void insertion(benchmark::State& state, char letter, Grading grading, int threads) {
  const RunScope run({.threads = threads});
  const SquareCase domain(grading, static_cast<double>(state.range(0)));
  const auto placement = strategy(letter);
  size_t triangles = 0;
  for (auto _ : state) {
    triangles = mesh_frontal(domain.boundary(), *placement, domain.cross, domain.size).triangles.size();
  }
  state.counters["triangles"] = static_cast<double>(triangles);
  state.SetComplexityN(static_cast<benchmark::IterationCount>(triangles));
}

void triangulation_alone(benchmark::State& state, char letter, Grading grading) {
  using Delaunay = CGAL::Delaunay_triangulation_2<CGAL::Exact_predicates_inexact_constructions_kernel>;
  const SquareCase domain(grading, static_cast<double>(state.range(0)));
  const TriPatch mesh = mesh_frontal(domain.boundary(), *strategy(letter), domain.cross, domain.size);
  std::vector<Delaunay::Point> points;
  for (const Vec2 p : mesh.points) points.emplace_back(p.x, p.y);
  for (auto _ : state) {
    Delaunay delaunay;
    delaunay.insert(points.begin(), points.end());
    benchmark::DoNotOptimize(delaunay.number_of_vertices());
  }
  state.SetComplexityN(static_cast<benchmark::IterationCount>(mesh.triangles.size()));
}

void sizes(benchmark::internal::Benchmark* b) {
  b->RangeMultiplier(10)->Range(1000, 1000000)->Arg(2000000)->Unit(benchmark::kMillisecond)->Complexity();
}

BENCHMARK_CAPTURE(insertion, D_uniform, 'D', Grading::kUniform, 1)->Apply(sizes);
BENCHMARK_CAPTURE(triangulation_alone, D_uniform, 'D', Grading::kUniform)->Apply(sizes);
BENCHMARK_CAPTURE(insertion, D_graded, 'D', Grading::kGraded, 1)->Apply(sizes);
BENCHMARK_CAPTURE(triangulation_alone, D_graded, 'D', Grading::kGraded)->Apply(sizes);
BENCHMARK_CAPTURE(insertion, F_uniform, 'F', Grading::kUniform, 1)->Apply(sizes);
BENCHMARK_CAPTURE(triangulation_alone, F_uniform, 'F', Grading::kUniform)->Apply(sizes);
BENCHMARK_CAPTURE(insertion, F_graded, 'F', Grading::kGraded, 1)->Apply(sizes);
BENCHMARK_CAPTURE(triangulation_alone, F_graded, 'F', Grading::kGraded)->Apply(sizes);

BENCHMARK_CAPTURE(insertion, D_uniform_2_threads, 'D', Grading::kUniform, 2)
    ->Arg(1000000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace delquad::benchmarks
