// SPDX-License-Identifier: GPL-3.0-or-later
#include <benchmark/benchmark.h>

#include <string>

#include "algorithms/insertion/frontal_mesher.h"
#include "algorithms/recombination/recombine.h"
#include "algorithms/treatment/treatment.h"
#include "base/context.h"
#include "base/matching/matching.h"
#include "benchmarks/square_case.h"

// Times recombination and treatment of meshes of F and D, with the insertion of the same mesh as the scale.
// Recombination reports the dual graph, matching and merging, and has a row with LEMON's matching.

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

void recombination(benchmark::State& state, char letter, Grading grading, bool lemon, int threads) {
  const SquareCase domain(grading, static_cast<double>(state.range(0)));
  const TriPatch tri = triangles(letter, domain);
  const auto solver = lemon ? make_lemon_solver() : make_primal_dual_solver();
  RunSettings settings;
  settings.threads = threads;
  const RunScope scope(settings);
  RecombineSummary summary;
  double graph = 0, matching = 0, merging = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(recombine(tri, *solver, &summary).quads.data());
    graph += summary.graph_seconds;
    matching += summary.matching_seconds;
    merging += summary.merge_seconds;
  }
  constexpr double kPerSecond = 1000;
  const auto mean = [&](double seconds) {
    return benchmark::Counter(kPerSecond * seconds, benchmark::Counter::kAvgIterations);
  };
  state.counters["graph_ms"] = mean(graph);
  state.counters["matching_ms"] = mean(matching);
  state.counters["merging_ms"] = mean(merging);
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

/// LEMON has its own thread: only wall and process time count.
void wall_sizes(benchmark::internal::Benchmark* b) {
  sizes(b);
  b->MeasureProcessCPUTime()->UseRealTime();
}

void add_recombination(const std::string& family, char letter, Grading grading) {
  const auto add = [&](const std::string& name, bool lemon, int threads) {
    benchmark::RegisterBenchmark((name + "/" + family).c_str(), recombination, letter, grading, lemon,
                                 threads)
        ->Apply(wall_sizes);
  };
  add("recombination", false, 1);
  add("recombination_two_threads", false, 2);
  add("recombination_by_lemon", true, 1);
}

bool register_recombination() {
  add_recombination("D_graded", 'D', Grading::kGraded);
  add_recombination("F_graded", 'F', Grading::kGraded);
  add_recombination("D_uniform", 'D', Grading::kUniform);
  add_recombination("F_uniform", 'F', Grading::kUniform);
  return true;
}

const bool kRegistered = register_recombination();

BENCHMARK_CAPTURE(insertion, D_graded, 'D', Grading::kGraded)->Apply(sizes);
BENCHMARK_CAPTURE(treatment, D_graded, 'D', Grading::kGraded)->Apply(sizes);
BENCHMARK_CAPTURE(insertion, F_graded, 'F', Grading::kGraded)->Apply(sizes);
BENCHMARK_CAPTURE(treatment, F_graded, 'F', Grading::kGraded)->Apply(sizes);

}  // namespace
}  // namespace delquad::benchmarks
