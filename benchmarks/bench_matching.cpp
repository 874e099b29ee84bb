// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <string>
#include <utility>

#include "algorithms/insertion/frontal_mesher.h"
#include "algorithms/recombination/dual_graph.h"
#include "base/context.h"
#include "base/matching/matching.h"
#include "benchmarks/square_case.h"
#include "tests/base/matching/graph_kinds.h"

// Times matching alone, by our solver on one thread and on two, and by LEMON's, the baseline. Graphs are
// meshes of F and D, random cubic planar graphs, and the exact equilateral lattice. Each result of ours is
// proven by its certificate, untimed. LEMON has its own thread: only wall and process time count.

namespace delquad::benchmarks {
namespace {

MatchingGraph mesh_graph(char letter, Grading grading, int n) {
  const SquareCase domain(grading, n);
  const auto placement = letter == 'F' ? make_l2_frontal() : make_linf_delquad();
  return build_dual_graph(mesh_frontal(domain.boundary(), *placement, domain.cross, domain.size)).graph;
}

/// Returns the faces of the Delaunay triangulation of random points, infinite ones included, along a Hilbert
/// curve, with random costs.
MatchingGraph cubic_planar_graph(int n) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Faces = CGAL::Triangulation_face_base_with_info_2<int, Kernel>;
  using Triangulation = CGAL::Delaunay_triangulation_2<
      Kernel, CGAL::Triangulation_data_structure_2<CGAL::Triangulation_vertex_base_2<Kernel>, Faces>>;
  constexpr long long kLargest = 1'000'000;
  std::mt19937_64 random(5);
  const auto coordinate = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  std::vector<Kernel::Point_2> points(n / 2);
  for (auto& p : points) {
    const double x = coordinate();
    p = {x, coordinate()};
  }
  const Triangulation triangulation(points.begin(), points.end());
  std::vector<Triangulation::Face_handle> faces;
  std::vector<Vec2> places;
  for (const auto face : triangulation.all_face_handles()) {
    const auto& p = face->vertex(triangulation.is_infinite(face->vertex(0)) ? 1 : 0)->point();
    faces.push_back(face);
    places.push_back({p.x(), p.y()});
  }
  const std::vector<int> order = hilbert_order(places);
  MatchingGraph graph{static_cast<int>(faces.size()), {}};
  for (int i = 0; i < graph.n_nodes; ++i) faces[order[i]]->info() = i;
  for (int i = 0; i < graph.n_nodes; ++i) {
    for (int side = 0; side < 3; ++side) {
      const int other = faces[order[i]]->neighbor(side)->info();
      if (other > i) graph.edges.push_back({i, other, static_cast<long long>(random() % kLargest)});
    }
  }
  return graph;
}

MatchingGraph lattice_graph(int n) {
  // Rows are even, so that the number of triangles is even.
  const int rows = 2 * static_cast<int>(std::lround(std::sqrt(n) / 2));
  return testing_support::triangle_lattice(rows, kCostUnit / 3, kExtraEdgeCost);
}

MatchingGraph graph_of(const std::string& family, int n) {
  if (family == "D_uniform") return mesh_graph('D', Grading::kUniform, n);
  if (family == "D_graded") return mesh_graph('D', Grading::kGraded, n);
  if (family == "F_uniform") return mesh_graph('F', Grading::kUniform, n);
  if (family == "F_graded") return mesh_graph('F', Grading::kGraded, n);
  return family == "lattice" ? lattice_graph(n) : cubic_planar_graph(n);
}

/// Returns the last graph again, so that our solver and LEMON get the same one.
const MatchingGraph& kept_graph(const std::string& family, int n) {
  static std::pair<std::string, int> key;
  static MatchingGraph graph;
  if (key != std::pair(family, n)) {
    key = {family, n};
    graph = graph_of(family, n);
  }
  return graph;
}

void matching(benchmark::State& state, const std::string& family, bool lemon, int threads) {
  const MatchingGraph& graph = kept_graph(family, static_cast<int>(state.range(0)));
  RunSettings settings;
  settings.threads = threads;
  const RunScope scope(settings);
  const auto solver = lemon ? make_lemon_solver() : make_primal_dual_solver();
  MatchingResult result;
  for (auto _ : state) result = solver->solve(graph);
  std::string why;
  if (!lemon && !proves_optimal(graph, result.mate, result.certificate, &why))
    state.SkipWithError(why.c_str());
  state.counters["nodes"] = graph.n_nodes;
  state.counters["cost"] = static_cast<double>(result.cost);
  state.SetComplexityN(graph.n_nodes);
}

/// LEMON takes minutes for the largest meshes.
constexpr int kSmallest = 1000, kLargest = 1'000'000, kLargestOfOurs = 3'000'000;

void add_rows(const std::string& name, const std::string& family, bool lemon, int threads) {
  auto* const row = benchmark::RegisterBenchmark(name.c_str(), matching, family, lemon, threads);
  for (int n = kSmallest; n <= kLargest; n *= 10) row->Arg(n);
  if (!lemon) row->Arg(kLargestOfOurs);
  row->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime()->Complexity();
}

void register_all() {
  for (const std::string family :
       {"D_uniform", "D_graded", "F_uniform", "F_graded", "cubic_planar", "lattice"}) {
    add_rows("ours/" + family, family, false, 1);
    add_rows("ours_two_threads/" + family, family, false, 2);
    add_rows("lemon/" + family, family, true, 1);
  }
}

const bool kRegistered = (register_all(), true);

}  // namespace
}  // namespace delquad::benchmarks
