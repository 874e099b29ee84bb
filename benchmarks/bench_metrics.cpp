// SPDX-License-Identifier: GPL-3.0-or-later
#include <benchmark/benchmark.h>

#include "algorithms/insertion/frontal_mesher.h"
#include "algorithms/recombination/recombine.h"
#include "benchmarks/square_case.h"

namespace delquad::benchmarks {
namespace {

void metrics(benchmark::State& state) {
  const SquareCase domain(Grading::kGraded, static_cast<double>(state.range(0)));
  const TriPatch tri = mesh_frontal(domain.boundary(), *make_linf_delquad(), domain.cross, domain.size);
  const QuadPatch patch = recombine(tri, *make_primal_dual_solver());
  Mesh mesh = domain.domain.boundary;
  mesh.points.clear();
  for (const Vec2 p : patch.points) mesh.points.push_back({p.x, p.y, 0});
  mesh.quads = patch.quads;
  mesh.quad_region.assign(mesh.quads.size(), 0);
  for (auto _ : state) benchmark::DoNotOptimize(evaluate_metrics(mesh, &domain.size).values.size());
  state.SetComplexityN(static_cast<benchmark::IterationCount>(patch.quads.size()));
}

BENCHMARK(metrics)->RangeMultiplier(10)->Range(1000, 1000000)->Unit(benchmark::kMillisecond)->Complexity();

}  // namespace
}  // namespace delquad::benchmarks
