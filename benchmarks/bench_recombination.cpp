#include <benchmark/benchmark.h>

#include "algorithms/insertion/frontal_mesher.h"
#include "algorithms/recombination/recombine.h"
#include "algorithms/treatment/treatment.h"
#include "benchmarks/square_case.h"

// Recombination (dual graph, matching, merge) and treatment of the meshes of F and D, with the insertion of
// the same mesh as the yardstick.

namespace delquad::benchmarks {
namespace {

TriPatch triangles(char letter, const SquareCase& domain) {
  const auto placement = letter == 'F' ? make_l2_frontal() : make_linf_delquad();
  return mesh_frontal(domain.boundary(), *placement, domain.cross, domain.size);
}

void insertion(benchmark::State& state, char letter, Grading grading) {
  const SquareCase domain(grading, static_cast<double>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(triangles(letter, domain).points.data());
  state.SetComplexityN(state.range(0));
}

void recombination(benchmark::State& state, char letter, Grading grading) {
  const SquareCase domain(grading, static_cast<double>(state.range(0)));
  const TriPatch tri = triangles(letter, domain);
  const auto solver = make_primal_dual_solver();
  RecombineSummary summary;
  for (auto _ : state) benchmark::DoNotOptimize(recombine(tri, *solver, &summary).quads.data());
  state.counters["matching_share"] =
      summary.matching_seconds / (summary.graph_seconds + summary.matching_seconds + summary.merge_seconds);
  state.SetComplexityN(static_cast<benchmark::IterationCount>(tri.triangles.size()));
}

void treatment(benchmark::State& state, char letter, Grading grading) {
  const SquareCase domain(grading, static_cast<double>(state.range(0)));
  const QuadPatch raw = recombine(triangles(letter, domain), *make_primal_dual_solver());
  for (auto _ : state) benchmark::DoNotOptimize(treat_paper(raw, domain.size).quads.data());
  state.SetComplexityN(static_cast<benchmark::IterationCount>(raw.quads.size()));
}

void sizes(benchmark::internal::Benchmark* b) {
  b->RangeMultiplier(10)->Range(1000, 1000000)->Unit(benchmark::kMillisecond)->Complexity();
}

BENCHMARK_CAPTURE(insertion, D_graded, 'D', Grading::kGraded)->Apply(sizes);
BENCHMARK_CAPTURE(recombination, D_graded, 'D', Grading::kGraded)->Apply(sizes);
BENCHMARK_CAPTURE(treatment, D_graded, 'D', Grading::kGraded)->Apply(sizes);
BENCHMARK_CAPTURE(insertion, F_graded, 'F', Grading::kGraded)->Apply(sizes);
BENCHMARK_CAPTURE(recombination, F_graded, 'F', Grading::kGraded)->Apply(sizes);
BENCHMARK_CAPTURE(treatment, F_graded, 'F', Grading::kGraded)->Apply(sizes);
BENCHMARK_CAPTURE(recombination, D_uniform, 'D', Grading::kUniform)->Apply(sizes);
BENCHMARK_CAPTURE(recombination, F_uniform, 'F', Grading::kUniform)->Apply(sizes);

}  // namespace
}  // namespace delquad::benchmarks
