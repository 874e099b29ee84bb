#include "smoothing/optimisation/quad_optimisation.h"

#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include "smoothing/optimisation/quad_energy.h"
#include "smoothing/quad_relocation.h"
#include "smoothing/short_edges.h"
#include "smoothing/untangling.h"

namespace delquad {

namespace {

/// A corner with this sine or less is flat or inverted: its quad is untangled, or else held.
constexpr double kFlatSine = 1e-3;
/// Rings of elements around those that are untangled with them.
constexpr int kUntanglingRings = 2;
/// Quads whose least sine is within this part of the barrier's stay as they are; and the barrier stands so
/// much below what the pass for the worst quads starts from.
constexpr double kBarrierRoom = 0.005;
/// Vectors that L-BFGS remembers.
constexpr int kMemory = 12;
/// The pass for the worst: quads below this eta, with so many rings around them.
constexpr double kWorstEta = 0.6;
constexpr int kWorstRings = 2;
/// Weight and exponent of bad quads there: about the 6th power of |angle - 90 degrees|.
constexpr double kWorstWeight = 30, kWorstPower = 3;

double sine_of(double eta) { return std::sin(eta * std::numbers::pi / 2); }
double eta_of(double sine) { return std::max(0.0, 2 / std::numbers::pi * std::asin(std::min(sine, 1.0))); }

class Energy final : public ceres::FirstOrderFunction {
 public:
  explicit Energy(const QuadEnergy& energy) : energy_(energy) {}
  bool Evaluate(const double* parameters, double* cost, double* gradient) const override {
    return energy_.evaluate(parameters, *cost, gradient);
  }
  int NumParameters() const override { return energy_.variables(); }

 private:
  const QuadEnergy& energy_;
};

class Optimisation {
 public:
  Optimisation(const QuadPatch& mesh, const ParametricSize& size, const CrossField& cross,
               const OptimisationOptions& options)
      : mesh_(mesh), size_(size), cross_(cross), options_(options) {}

  void run();
  QuadPatch result() const { return mesh_; }
  const OptimisationSummary& summary() const { return summary_; }

 private:
  void untangle_flat();
  void hold_what_is_left();
  void minimise(const std::vector<char>& free, const QuadEnergyWeights& weights, double least_sine);
  void lift_worst();
  std::vector<char> off_the_barrier() const;
  double movable_sine(const QuadTopology& topology, int quad) const;
  double least() const;

  QuadPatch mesh_;
  const ParametricSize& size_;
  const CrossField& cross_;
  OptimisationOptions options_;
  QuadEnergyWeights weights_;
  double barrier_ = 0;      ///< no sine falls to it
  std::vector<char> free_;  ///< by vertex
  OptimisationSummary summary_;
};

/// The vertices of some elements and of `rings` rings of elements around.
std::vector<char> near(const QuadTopology& topology, const std::vector<char>& elements, int rings) {
  std::vector<char> vertex(topology.vertex_slots(), 0), inside = elements;
  for (int ring = 0;; ++ring) {
    for (int e = 0; e < topology.element_slots(); ++e)
      for (int k = 0; inside[e] && k < 4; ++k)
        if (const int v = topology.corner(e, k); v >= 0) vertex[v] = 1;
    if (ring == rings) return vertex;
    for (int e = 0; e < topology.element_slots(); ++e)
      for (int k = 0; k < 4; ++k)
        if (const int v = topology.corner(e, k); v >= 0 && vertex[v]) inside[e] = 1;
  }
}

std::vector<char> quads_below(const QuadTopology& topology, double sine) {
  std::vector<char> below(topology.element_slots(), 0);
  for (int e = 0; e < topology.element_slots(); ++e)
    below[e] = topology.is_quad(e) && least_sine(topology, e) <= sine;
  return below;
}

void Optimisation::untangle_flat() {
  QuadTopology topology(mesh_);
  if (lengthen_short_edges(topology, size_) > 0) mesh_ = topology.to_patch();
  const auto flat = quads_below(topology, kFlatSine);
  const auto n = std::count(flat.begin(), flat.end(), 1);
  if (n == 0) return;
  const auto around = near(topology, flat, kUntanglingRings);
  std::vector<int> vertices;
  for (int v = mesh_.n_boundary; v < topology.vertex_slots(); ++v)
    if (around[v]) vertices.push_back(v);
  untangle(topology, vertices);
  const auto left = quads_below(topology, kFlatSine);
  const auto n_left = std::count(left.begin(), left.end(), 1);
  if (n_left >= n) return;
  summary_.untangled = static_cast<int>(n - n_left);
  for (const int v : vertices) mesh_.points[v] = topology.point(v);
}

void Optimisation::hold_what_is_left() {
  const QuadTopology topology(mesh_);
  free_.assign(mesh_.points.size(), 1);
  std::fill_n(free_.begin(), mesh_.n_boundary, 0);
  const auto hold = [&](int v) {
    if (v < mesh_.n_boundary || !free_[v]) return;
    free_[v] = 0;
    ++summary_.held;
  };
  const auto flat = quads_below(topology, kFlatSine);
  for (std::size_t q = 0; q < mesh_.quads.size(); ++q)
    if (flat[q]) std::for_each(mesh_.quads[q].begin(), mesh_.quads[q].end(), hold);
  for (const auto& t : mesh_.triangles) std::for_each(t.begin(), t.end(), hold);
}

/// Least sine of the quad's corners that can move; 1 without any.
double Optimisation::movable_sine(const QuadTopology& topology, int quad) const {
  const auto sines = corner_sines(topology, quad);
  const auto& v = mesh_.quads[quad];
  double least = 1;
  for (int k = 0; k < 4; ++k)
    if (free_[v[(k + 3) % 4]] || free_[v[k]] || free_[v[(k + 1) % 4]]) least = std::min(least, sines[k]);
  return least;
}

double Optimisation::least() const {
  const QuadTopology topology(mesh_);
  double sine = 1;
  for (std::size_t q = 0; q < mesh_.quads.size(); ++q)
    sine = std::min(sine, movable_sine(topology, static_cast<int>(q)));
  return sine;
}

/// Moves the free vertices, all sines staying above `least_sine`.
void Optimisation::minimise(const std::vector<char>& free, const QuadEnergyWeights& weights,
                            double least_sine) {
  std::vector<double> delta(mesh_.points.size());
  std::vector<Cross> crosses(mesh_.points.size());
  int size_hint = -1, cross_hint = -1;
  for (std::size_t v = 0; v < mesh_.points.size(); ++v) {
    delta[v] = size_.at(mesh_.points[v], size_hint);
    const Cross c = cross_.at(mesh_.points[v], cross_hint);
    const double n = std::hypot(c.c, c.s);
    crosses[v] = n > 0 ? Cross{c.c / n, c.s / n} : Cross{0, 0};
  }
  const QuadEnergy energy(mesh_, free, delta, crosses, least_sine, weights);
  if (energy.variables() == 0) return;
  std::vector<double> displacement(energy.variables(), 0.0);
  ceres::GradientProblemSolver::Options solver;
  solver.line_search_direction_type = ceres::LBFGS;
  solver.line_search_type = ceres::WOLFE;
  solver.max_lbfgs_rank = kMemory;
  solver.max_num_iterations = options_.iterations;
  solver.function_tolerance = 1e-5;
  solver.gradient_tolerance = 0;
  solver.parameter_tolerance = 1e-9;
  solver.logging_type = ceres::SILENT;
  ceres::GradientProblemSolver::Summary report;
  const ceres::GradientProblem problem(new Energy(energy));
  ceres::Solve(solver, problem, displacement.data(), &report);
  summary_.iterations += static_cast<int>(report.iterations.size());
  summary_.evaluations += report.num_cost_evaluations + report.num_gradient_evaluations;
  summary_.energy_before = report.initial_cost;
  summary_.energy_after = report.final_cost;
  double value = 0;
  if (energy.evaluate(displacement.data(), value, nullptr)) mesh_.points = energy.points(displacement.data());
}

/// The vertices that move without quads that stand at the barrier.
std::vector<char> Optimisation::off_the_barrier() const {
  const QuadTopology topology(mesh_);
  std::vector<char> free = free_;
  for (std::size_t q = 0; q < mesh_.quads.size(); ++q)
    if (movable_sine(topology, static_cast<int>(q)) < (1 + kBarrierRoom) * barrier_)
      for (const int v : mesh_.quads[q]) free[v] = 0;
  return free;
}

void Optimisation::lift_worst() {
  const QuadTopology topology(mesh_);
  std::vector<char> worst(mesh_.quads.size() + mesh_.triangles.size(), 0);
  for (std::size_t q = 0; q < mesh_.quads.size(); ++q)
    worst[q] = movable_sine(topology, static_cast<int>(q)) < sine_of(kWorstEta);
  std::vector<char> free = near(topology, worst, kWorstRings);
  for (std::size_t v = 0; v < free.size(); ++v) free[v] &= free_[v];
  const double before = least();
  const std::vector<Vec2> places = mesh_.points;
  QuadEnergyWeights weights = weights_;
  weights.bad = kWorstWeight;
  weights.bad_power = kWorstPower;
  minimise(free, weights, (1 - kBarrierRoom) * std::min(before, sine_of(kWorstEta)));
  if (least() < before) mesh_.points = places;
}

void Optimisation::run() {
  untangle_flat();
  hold_what_is_left();
  const double worst = least();
  summary_.worst_before = eta_of(worst);
  barrier_ = std::min(worst, sine_of(kOptimisedFloorEta));
  weights_.size = options_.size;
  weights_.alignment = options_.alignment;
  lift_worst();
  for (int pass = 0; pass < options_.passes; ++pass) minimise(off_the_barrier(), weights_, barrier_);
  const double before = summary_.energy_before, after = summary_.energy_after;
  lift_worst();
  summary_.energy_before = before, summary_.energy_after = after;
  summary_.worst_after = eta_of(least());
}

}  // namespace

QuadPatch optimise_vertices(const QuadPatch& mesh, const ParametricSize& size, const CrossField& cross,
                            const OptimisationOptions& options, OptimisationSummary* summary) {
  const auto start = std::chrono::steady_clock::now();
  Optimisation optimisation(mesh, size, cross, options);
  optimisation.run();
  if (summary != nullptr) {
    *summary = optimisation.summary();
    summary->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  return optimisation.result();
}

}  // namespace delquad
