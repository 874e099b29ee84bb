// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/optimisation/quad_energy.h"

#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "base/cancel.h"
#include "base/parallel.h"
#include "delquad/error.h"
#include "geometry/mesh/quad_corners.h"

namespace delquad {

namespace {

/// Widths at which the kinks of |angle - 90 degrees| (radians) and |log(l/d)| are rounded off.
constexpr double kShapeKink = 0.03, kSizeKink = 0.02;
/// Excess over the walls of lengths, as a logarithm, that can still be repaired.
constexpr double kCurable = 0.25;
/// Least knee: a lower one would let bad quads drown the others.
constexpr double kLeastKnee = 0.15;
/// Weight of edges near their least length, and the factor of that length below which they are near.
constexpr double kTooShort = 0.3, kNear = 1.5;
/// Quads in a piece.
constexpr std::size_t kPieceLength = 1024;

double power(double x, int n) {
  double result = 1;
  for (; n > 0; --n) result *= x;
  return result;
}

}  // namespace

template <class Vec>
QuadEnergy<Vec>::QuadEnergy(QuadEnergyMesh<Vec> mesh, const QuadEnergyWeights& weights)
    : weights_(weights), start_(std::move(mesh.points)), moving_(std::move(mesh.moving)) {
  assert(mesh.delta.size() == start_.size());
  assert(std::ranges::all_of(mesh.delta, [](double delta) { return delta > 0; }));
  assert(mesh.least_lengths.size() == mesh.quads.size() && mesh.kept_sine.size() == mesh.quads.size());
  assert(mesh.weight.size() == mesh.quads.size());
  slot_of_.assign(start_.size(), -1);
  add_pieces(mesh);
  find_slots_of_moving();
  for (const Slot& slot : slots_) at_.push_back(start_[slot.vertex]);
  slope_.resize(slots_.size());
  states_.resize(sides_.size());
  energies_.resize(pieces_.size());
}

/// Adds quads and edges that can move, first with vertices, then with slots piece by piece.
template <class Vec>
void QuadEnergy<Vec>::add_pieces(const QuadEnergyMesh<Vec>& mesh) {
  std::vector<int> moving(start_.size(), -1);
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    assert(moving[moving_[i].vertex] < 0);
    moving[moving_[i].vertex] = static_cast<int>(i);
  }
  const auto moves = [&](int v) { return moving[v] >= 0; };
  std::vector<int> first_side(start_.size(), -1),
      next_side;  // known sides, chained by their lower end
  std::size_t quads_begin = 0, edges_begin = 0;
  std::vector<int> other_end;
  const auto is_new = [&](int a, int b) {
    for (int i = first_side[std::min(a, b)]; i >= 0; i = next_side[i])
      if (other_end[i] == std::max(a, b)) return false;
    next_side.push_back(first_side[std::min(a, b)]);
    other_end.push_back(std::max(a, b));
    first_side[std::min(a, b)] = static_cast<int>(next_side.size()) - 1;
    return true;
  };
  for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
    const auto& v = mesh.quads[q];
    if (std::none_of(v.begin(), v.end(), moves)) continue;
    unsigned movable = 0;
    for (int k = 0; k < 4; ++k)
      if (moves(v[(k + 3) % 4]) || moves(v[k]) || moves(v[(k + 1) % 4])) movable |= 1U << k;
    quads_.push_back({v, movable, quad_normal(start_[v[2]] - start_[v[0]], start_[v[3]] - start_[v[1]]),
                      std::max(mesh.kept_sine[q], kLeastKnee), mesh.weight[q]});
    for (int k = 0; k < 4; ++k) {
      const int a = v[k], b = v[(k + 1) % 4];
      if ((!moves(a) && !moves(b)) || !is_new(a, b)) continue;
      edges_.push_back({-1, 2 / (mesh.delta[a] + mesh.delta[b]), mesh.least_lengths[q][k],
                        mesh.arm(static_cast<int>(q), k)});
      ends_.push_back({a, b});
    }
    if (quads_.size() - quads_begin < kPieceLength) continue;
    add_slots(quads_begin, edges_begin, moving);
    quads_begin = quads_.size(), edges_begin = edges_.size();
  }
  if (quads_begin < quads_.size()) add_slots(quads_begin, edges_begin, moving);
}

template <class Vec>
void QuadEnergy<Vec>::add_slots(std::size_t quads_begin, std::size_t edges_begin,
                                const std::vector<int>& moving) {
  const std::size_t first = slots_.size();
  const auto to_slot = [&](int& v) {
    int& slot = slot_of_[v];
    if (slot < static_cast<int>(first)) {
      slot = static_cast<int>(slots_.size());
      slots_.push_back({v, moving[v]});
    }
    v = slot;
  };
  for (std::size_t q = quads_begin; q < quads_.size(); ++q) std::ranges::for_each(quads_[q].sides, to_slot);
  for (std::size_t e = edges_begin; e < edges_.size(); ++e) std::ranges::for_each(ends_[e], to_slot);
  add_sides(quads_begin, edges_begin, first);
  pieces_.push_back({quads_.size(), edges_.size(), slots_.size(), sides_.size()});
}

/// Replaces slots by sides.
template <class Vec>
void QuadEnergy<Vec>::add_sides(std::size_t quads_begin, std::size_t edges_begin, std::size_t slots_begin) {
  // Sides are chained by their lower end.
  const int sides_begin = static_cast<int>(sides_.size());
  std::vector<int> first(slots_.size() - slots_begin, -1), following;
  const auto side_of = [&](int a, int b) {
    int& chain = first[std::min(a, b) - slots_begin];
    for (int s = chain; s >= 0; s = following[s - sides_begin]) {
      if (sides_[s].a == a && sides_[s].b == b) return s;
      if (sides_[s].a == b && sides_[s].b == a) return ~s;
    }
    following.push_back(chain);
    chain = static_cast<int>(sides_.size());
    sides_.push_back({a, b});
    return chain;
  };
  for (std::size_t q = quads_begin; q < quads_.size(); ++q) {
    const std::array<int, 4> v = quads_[q].sides;
    for (int k = 0; k < 4; ++k) quads_[q].sides[k] = side_of(v[k], v[(k + 1) % 4]);
  }
  for (std::size_t e = edges_begin; e < edges_.size(); ++e) {
    const int s = side_of(ends_[e][0], ends_[e][1]);
    edges_[e].side = s < 0 ? ~s : s;
  }
}

template <class Vec>
void QuadEnergy<Vec>::find_slots_of_moving() {
  first_slot_.assign(moving_.size() + 1, 0);
  for (const Slot& slot : slots_)
    if (slot.moving >= 0) ++first_slot_[slot.moving + 1];
  std::partial_sum(first_slot_.begin(), first_slot_.end(), first_slot_.begin());
  slots_of_moving_.resize(first_slot_.back());
  std::vector<std::size_t> next(first_slot_.begin(), first_slot_.end() - 1);
  for (std::size_t s = 0; s < slots_.size(); ++s)
    if (slots_[s].moving >= 0) slots_of_moving_[next[slots_[s].moving]++] = static_cast<int>(s);
}

template <class Vec>
Vec QuadEnergy<Vec>::place(int moving, const double* x) const {
  const auto& [vertex, axes] = moving_[moving];
  return start_[vertex] + (x[2 * moving] * axes[0] + x[2 * moving + 1] * axes[1]);
}

template <class Vec>
std::vector<Vec> QuadEnergy<Vec>::points(const double* x) const {
  std::vector<Vec> at = start_;
  for (std::size_t i = 0; i < moving_.size(); ++i) at[moving_[i].vertex] = place(static_cast<int>(i), x);
  return at;
}

template <class Vec>
bool QuadEnergy<Vec>::evaluate(const double* x, double& energy, double* gradient) const {
  parallel_for(pieces_.size(), [&](std::size_t p) { energies_[p] = piece_energy(p, x); });
  energy = std::accumulate(energies_.begin(), energies_.end(), 0.0);
  if (!std::isfinite(energy)) return false;
  if (gradient == nullptr) return true;
  parallel_ranges(moving_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Vec slope;
      for (std::size_t k = first_slot_[i]; k < first_slot_[i + 1]; ++k)
        slope = slope + slope_[slots_of_moving_[k]];
      gradient[2 * i] = dot(moving_[i].axes[0], slope);
      gradient[2 * i + 1] = dot(moving_[i].axes[1], slope);
    }
  });
  return true;
}

/// Returns the energy of a piece, and sets the slopes of its slots.
template <class Vec>
double QuadEnergy<Vec>::piece_energy(std::size_t piece, const double* x) const {
  const Piece begin = piece == 0 ? Piece{0, 0, 0, 0} : pieces_[piece - 1], end = pieces_[piece];
  for (std::size_t s = begin.slots_end; s < end.slots_end; ++s) {
    if (slots_[s].moving >= 0) at_[s] = place(slots_[s].moving, x);
    slope_[s] = {};
  }
  for (std::size_t s = begin.sides_end; s < end.sides_end; ++s) {
    const Vec along = at_[sides_[s].b] - at_[sides_[s].a];
    const double length = norm(along), inverse = 1 / length;
    states_[s] = {inverse * along, inverse, length, {}};
  }
  double energy = 0;
  for (std::size_t q = begin.quads_end; q < end.quads_end; ++q) energy += add_quad(quads_[q]);
  for (std::size_t e = begin.edges_end; e < end.edges_end; ++e) energy += add_edge(edges_[e]);
  for (std::size_t s = begin.sides_end; s < end.sides_end; ++s) {
    const auto [a, b] = sides_[s];
    slope_[a] = slope_[a] - states_[s].slope;
    slope_[b] = slope_[b] + states_[s].slope;
  }
  return energy;
}

template <class Vec>
double QuadEnergy<Vec>::add_quad(const Quad& quad) const {
  Vec side[4];  // unit vectors
  double inverse[4], sign[4];
  SideState* states[4];
  for (int k = 0; k < 4; ++k) {
    const int s = quad.sides[k];
    states[k] = &states_[s < 0 ? ~s : s];
    sign[k] = s < 0 ? -1 : 1;
    side[k] = sign[k] * states[k]->u;
    inverse[k] = states[k]->inverse;
  }
  const QuadCorner<Vec> corner[4] = {{side[3], side[0], quad.normal},
                                     {side[0], side[1], quad.normal},
                                     {side[1], side[2], quad.normal},
                                     {side[2], side[3], quad.normal}};
  double shape = kShapeKink * kShapeKink / 2, by_sine[4] = {};
  for (int k = 0; k < 4; ++k) {
    if (!quad.moves(k)) continue;
    const double inverse_sine = 1 / std::max(corner[k].sine, quad.knee),
                 below = std::max(0.0, 1 - corner[k].sine / quad.knee);
    shape += inverse_sine * (1 + below + below * below) - 1;
    by_sine[k] = -inverse_sine * inverse_sine * (1 + 2 * below);
  }
  const double good = quad.weight * std::sqrt(shape),
               bad = quad.weight * weights_.bad * power(shape, weights_.bad_power);
  // Sine and cosine of the sum of two opposite angles.
  const double cosine[2] = {-dot(side[3], side[0]), -dot(side[1], side[2])};
  const double sum_sine = corner[0].sine * cosine[1] + cosine[0] * corner[2].sine,
               sum_cosine = cosine[0] * cosine[1] - corner[0].sine * corner[2].sine;
  const double by_sum = 2 * weights_.orthogonality * sum_sine * sum_cosine;
  const double steep = (0.5 * good + weights_.bad_power * bad) / shape;
  Vec by_side[4];
  for (int k = 0; k < 4; ++k) {
    if (!quad.moves(k)) continue;
    const int before = (k + 3) % 4;
    // The derivative of the sine by the angle between both sides is their cosine.
    const double by_turn = steep * by_sine[k] * dot(side[before], side[k]) - (k % 2 == 0 ? by_sum : 0);
    by_side[before] = by_side[before] - by_turn * inverse[before] * corner[k].quarter_turn(side[before]);
    by_side[k] = by_side[k] + by_turn * inverse[k] * corner[k].quarter_turn(side[k]);
  }
  for (int k = 0; k < 4; ++k) states[k]->slope = states[k]->slope + sign[k] * by_side[k];
  return good + bad + weights_.orthogonality * sum_sine * sum_sine;
}

template <class Vec>
double QuadEnergy<Vec>::add_edge(const Edge& edge) const {
  SideState& side = states_[edge.side];
  const double length = side.length, inverse = side.inverse;
  // Hyperbolic sine and cosine of log(l/d); their difference is min(l/d, d/l).
  const double ratio = length * edge.inverse_length, cosh = 0.5 * (ratio + 1 / ratio), sinh = ratio - cosh;
  const double rounded = std::sqrt(sinh * sinh + kSizeKink * kSizeKink), deficit = cosh - rounded + kSizeKink;
  const Vec u = side.u;
  // sin^2 2 phi = 4 c^2 (1 - c^2), with the cosine c between edge and arm.
  const double c = dot(u, edge.arm), c2 = c * c;
  const double near = std::max(kNear * edge.least_length * inverse - 1, 0.0);
  // Missing length as a logarithm; negative if the edge is too long.
  const double lacks = ratio < weights_.short_wall  ? std::log(weights_.short_wall / ratio)
                       : ratio > weights_.long_wall ? std::log(weights_.long_wall / ratio)
                                                    : 0;
  const double soft = 1 / (1 + lacks * lacks / (kCurable * kCurable));
  const double by_length = weights_.size * sinh * (cosh / rounded - 1) * inverse -
                           2 * weights_.wall * lacks * soft * soft * inverse -
                           2 * kTooShort * near * (near + 1) * inverse;
  const double by_cosine = 8 * weights_.alignment * c * (1 - 2 * c2) * inverse;
  side.slope = side.slope + (by_length * u + by_cosine * (edge.arm - c * u));
  return weights_.size * (1 - deficit) + weights_.wall * lacks * lacks * soft +
         4 * weights_.alignment * c2 * (1 - c2) + kTooShort * near * near;
}

template class QuadEnergy<Vec2>;
template class QuadEnergy<Vec3>;

namespace {

/// Steps that L-BFGS remembers; more cost as much time as they save.
constexpr int kMemory = 5;
/// The descent ends if a step gains less than this part of the energy.
constexpr double kLeastGain = 4e-4;

template <class Vec>
class CeresEnergy final : public ceres::FirstOrderFunction {
 public:
  explicit CeresEnergy(const QuadEnergy<Vec>& energy) : energy_(energy) {}
  bool Evaluate(const double* parameters, double* cost, double* gradient) const override {
    // The solver passes no exceptions. It stops if an evaluation fails.
    try {
      return energy_.evaluate(parameters, *cost, gradient);
    } catch (const Cancelled&) {
      return false;
    }
  }
  int NumParameters() const override { return energy_.variables(); }

 private:
  const QuadEnergy<Vec>& energy_;
};

}  // namespace

template <class Vec>
EnergyDescent minimise(const QuadEnergy<Vec>& energy, int max_iterations) {
  EnergyDescent descent;
  descent.x.assign(energy.variables(), 0.0);
  if (descent.x.empty()) return descent;
  assert(energy.evaluate(descent.x.data(), descent.energy_before, nullptr));
  ceres::GradientProblemSolver::Options options;
  options.line_search_direction_type = ceres::LBFGS;
  options.line_search_type = ceres::WOLFE;
  options.max_lbfgs_rank = kMemory;
  options.use_approximate_eigenvalue_bfgs_scaling = true;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = kLeastGain;
  options.gradient_tolerance = 0;
  options.parameter_tolerance = 1e-9;
  options.logging_type = ceres::SILENT;
  ceres::GradientProblemSolver::Summary report;
  const ceres::GradientProblem problem(new CeresEnergy<Vec>(energy));
  ceres::Solve(options, problem, descent.x.data(), &report);
  check_cancelled();
  descent.iterations = static_cast<int>(report.iterations.size());
  descent.evaluations = report.num_cost_evaluations + report.num_gradient_evaluations;
  descent.energy_before = report.initial_cost;
  descent.energy_after = report.final_cost;
  // The solver may leave its last trial, with infinite energy.
  double value = 0;
  if (!energy.evaluate(descent.x.data(), value, nullptr)) descent.x.assign(descent.x.size(), 0.0);
  return descent;
}

template EnergyDescent minimise(const QuadEnergy<Vec2>&, int);
template EnergyDescent minimise(const QuadEnergy<Vec3>&, int);

}  // namespace delquad
