// SPDX-License-Identifier: GPL-3.0-or-later
#include <benchmark/benchmark.h>

#include "algorithms/fields/fields.h"
#include "benchmarks/square_case.h"

// Times the background mesh, its harmonic cross field, and queries of the field, by the number of boundary
// edges.

namespace delquad::benchmarks {
namespace {

SquareCase with_boundary_edges(double edges) { return {Grading::kGraded, edges * edges / 2}; }

void background(benchmark::State& state) {
  const SquareCase domain = with_boundary_edges(static_cast<double>(state.range(0)));
  for (auto _ : state)
    benchmark::DoNotOptimize(BackgroundMesh(domain.domain.patches).triangles().points.data());
  state.SetComplexityN(static_cast<benchmark::IterationCount>(domain.boundary().points.size()));
}

void harmonic_cross_field(benchmark::State& state) {
  const SquareCase domain = with_boundary_edges(static_cast<double>(state.range(0)));
  const auto mesh = std::make_shared<BackgroundMesh>(domain.domain.patches);
  for (auto _ : state) benchmark::DoNotOptimize(HarmonicCrossField(mesh).index_sum());
  state.counters["background_triangles"] = static_cast<double>(mesh->triangles().triangles.size());
  state.SetComplexityN(static_cast<benchmark::IterationCount>(domain.boundary().points.size()));
}

void query(benchmark::State& state) {
  const SquareCase domain = with_boundary_edges(static_cast<double>(state.range(0)));
  const HarmonicCrossField field(std::make_shared<BackgroundMesh>(domain.domain.patches));
  int hint = -1, i = 0;
  for (auto _ : state) {
    // A slow spiral: consecutive points are close, as in a mesher.
    const double r = 0.6 * (++i % 10000) / 10000, t = 0.01 * i;
    benchmark::DoNotOptimize(field.at({r * std::cos(t), 0.3 + r * std::sin(t)}, hint));
  }
}

BENCHMARK(background)->RangeMultiplier(4)->Range(64, 16384)->Unit(benchmark::kMillisecond)->Complexity();
BENCHMARK(harmonic_cross_field)
    ->RangeMultiplier(4)
    ->Range(64, 16384)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();
BENCHMARK(query)->RangeMultiplier(16)->Range(64, 16384);

}  // namespace
}  // namespace delquad::benchmarks
