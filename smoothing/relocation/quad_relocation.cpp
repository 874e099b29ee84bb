// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/relocation/quad_relocation.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "base/box.h"
#include "base/cancel.h"
#include "smoothing/relocation/element_quality.h"

namespace delquad {

namespace {

/// Weight of the length term against the corner terms.
constexpr double kLengthWeight = 0.12;
/// Sine below which the steep term of a corner starts, and its factor.
constexpr double kSteepSine = 0.05, kSteep = 40;
/// Square of the misfit (logarithm of length / delta) above which the length term levels off.
constexpr double kHopeless = 2;
/// Length of a step, in Newton steps.
constexpr double kOverRelaxation = 1.4;
/// Limit of a step, in shortest edges.
constexpr double kLongestStep = 0.4;
/// delta' is evaluated again after a move of this part of it.
constexpr double kDeltaReach = 0.15;
/// Steps of the search that lifts a vertex's worst corner.
constexpr int kLiftSteps = 10;

/// Two numbers, processed together.
using Pair = double __attribute__((vector_size(16)));

template <class Number>
constexpr std::size_t kWidth = sizeof(Number) / sizeof(double);

template <class Number>
Number load(const double* from) {
  Number all;
  std::memcpy(&all, from, sizeof(Number));
  return all;
}

template <class Number>
void store(const Number& all, double* to) {
  std::memcpy(to, &all, sizeof(Number));
}

double square_root(double x) { return std::sqrt(x); }
Pair square_root(Pair x) { return Pair{std::sqrt(x[0]), std::sqrt(x[1])}; }
double sum_of(double x) { return x; }
double sum_of(Pair x) { return x[0] + x[1]; }
double least_of(double x) { return x; }
double least_of(Pair x) { return std::min(x[0], x[1]); }
template <class Number>
Number larger(Number a, Number b) {
  return a > b ? a : b;
}
template <class Number>
Number smaller(Number a, Number b) {
  return a < b ? a : b;
}

/// Returns log(x), within 0.2 % for x from 1/2 to 2, by its Pade approximant; bounded by 3.
template <class Number>
Number misfit_of(Number x) {
  return 3 * (x * x - 1) / (x * x + 4 * x + 1);
}

/// Sums over corners and edges.
template <class Number, bool kDerivatives>
struct Sums {
  Number cost{}, flat{}, least_sine = Number{} + 1;
  Number gx{}, gy{}, hxx{}, hxy{}, hyy{};

  /// Adds a corner. The vector (`turn_x`, `turn_y`) is the gradient of its angle.
  void add_corner(Number sine, Number cosine, Number turn_x, Number turn_y) {
    const Number zero{};
    const Number excess = larger(zero, kSteepSine - sine);
    cost += 1 - sine + kSteep * excess * excess;
    least_sine = smaller(least_sine, sine);
    flat += sine <= zero ? zero + 1 : zero;
    if constexpr (kDerivatives) {
      const Number slope = 1 + 2 * kSteep * excess;  // of the cost by the sine
      const Number first = -slope * cosine;
      const Number steep = excess > zero ? 2 * kSteep * cosine * cosine : zero;
      const Number second = larger(slope * sine + steep, zero + 0.1);
      gx += first * turn_x;
      gy += first * turn_y;
      hxx += second * turn_x * turn_x;
      hxy += second * turn_x * turn_y;
      hyy += second * turn_y * turn_y;
    }
  }
  /// Adds an edge. `wall` is the weight of walls at the misfits `low` and `high`.
  void add_edge(Number ux, Number uy, Number inverse, Number misfit, double wall, double low, double high) {
    const Number zero{};
    const Number beyond = smaller(zero, misfit - low) + larger(zero, misfit - high);
    const Number soft = 1 / (1 + misfit * misfit / kHopeless);
    cost += kLengthWeight * misfit * misfit * soft + wall * beyond * beyond;
    if constexpr (kDerivatives) {
      const Number first = -2 * (kLengthWeight * misfit * soft * soft + wall * beyond) * inverse;
      const Number steep = beyond != zero ? zero + wall : zero;
      const Number second = 2 * (kLengthWeight * soft * soft * soft + steep) * inverse * inverse;
      gx += first * ux;
      gy += first * uy;
      hxx += second * ux * ux;
      hxy += second * ux * uy;
      hyy += second * uy * uy;
    }
  }
};

}  // namespace

QuadRelocation::QuadRelocation(QuadTopology& mesh, const ParametricSize& size)
    : mesh_(mesh),
      size_(size),
      short_misfit_(std::log(limits().short_wall())),
      long_misfit_(std::log(limits().long_wall())) {
  adopt_new_vertices(0);
  for (int h = 0; h < 4 * mesh_.element_slots(); ++h) {
    if (mesh_.origin(h) < 0 || mesh_.twin(h) >= 0) continue;
    const int a = mesh_.origin(h), b = mesh_.target(h);
    const double length = norm(mesh_.point(b) - mesh_.point(a));
    room_.resize(std::max<std::size_t>(room_.size(), std::max(a, b) + 1), std::numeric_limits<double>::max());
    room_[a] = std::min(room_[a], length), room_[b] = std::min(room_[b], length);
  }
  narrow_.resize(room_.size(), 0);
  for (int e = 0; e < mesh_.element_slots(); ++e) {
    if (!mesh_.is_quad(e) || mesh_.origin(4 * e) < 0) continue;
    int vertices = 0, sides = 0;
    for (int k = 0; k < 4; ++k) {
      vertices += mesh_.on_boundary(mesh_.corner(e, k));
      sides += mesh_.twin(4 * e + k) < 0;
    }
    if (vertices <= sides + 1) continue;
    for (int k = 0; k < 4; ++k)
      if (const int v = mesh_.corner(e, k); mesh_.on_boundary(v)) narrow_[v] = 1;
  }
}

void QuadRelocation::adopt_new_vertices(int first) {
  const std::size_t n = mesh_.vertex_slots();
  hint_.resize(n, -1), delta_.resize(n), delta_at_.resize(n), active_.resize(n, 0);
  for (std::size_t v = first; v < n; ++v) {
    // Neighbors are close, and so are most consecutive points.
    if (v > 0) hint_[v] = hint_[v - 1];
    if (mesh_.vertex_alive(static_cast<int>(v)))
      mesh_.for_each_out(static_cast<int>(v), [&](int h) {
        if (mesh_.target(h) < static_cast<int>(v)) hint_[v] = hint_[mesh_.target(h)];
      });
    delta_at_[v] = mesh_.point(static_cast<int>(v));
    delta_[v] = size_.at(delta_at_[v], hint_[v]);
  }
}

void QuadRelocation::refresh_delta(int v) {
  const Vec2 at = mesh_.point(v);
  if (norm(at - delta_at_[v]) < kDeltaReach * delta_[v]) return;
  delta_at_[v] = at;
  delta_[v] = size_.at(at, hint_[v]);
}

void QuadRelocation::activate(int v) {
  if (active_[v] || mesh_.on_boundary(v) || !mesh_.vertex_alive(v)) return;
  active_[v] = 1;
  queue_.push_back(v);
}

void QuadRelocation::activate_all() {
  for (int v = 0; v < mesh_.vertex_slots(); ++v) activate(v);
}

void QuadRelocation::activate_all(const QuadBlock& block) {
  for (int v = 0; v < mesh_.vertex_slots(); ++v)
    if (block.is_near(v)) activate(v);
}

void QuadRelocation::activate_ring(int v) {
  activate(v);
  mesh_.for_each_out(v, [&](int h) {
    const int across = mesh_.next(h);
    activate(mesh_.origin(across));
    activate(mesh_.target(across));
  });
}

void QuadRelocation::Spokes::resize(std::size_t n) {
  for (auto* values : {&end_x, &end_y, &left_x, &left_y, &right_x, &right_y, &inverse_delta})
    values->resize(n);
}

void QuadRelocation::Rays::resize(std::size_t n) {
  for (auto* values : {&x, &y, &inverse, &misfit}) values->resize(n);
}

void QuadRelocation::gather(int v) {
  const std::size_t n = mesh_.valence(v);
  looks_ += static_cast<long long>(n);
  if (n > spokes_.end_x.size()) {
    spokes_.resize(n);
    rays_.resize(n + 1);
  }
  gathered_ = v;
  n_spokes_ = n;
  shortest_far_ = std::numeric_limits<double>::max(), longest_far_ = 0;
  const auto unit_along = [this](Vec2 side) {
    const double length = norm(side);
    shortest_far_ = std::min(shortest_far_, length), longest_far_ = std::max(longest_far_, length);
    return (1 / std::max(length, kTinyLength)) * side;
  };
  std::size_t i = 0;
  mesh_.for_each_out(v, [&](int h) {
    const int across = mesh_.next(h), end = mesh_.origin(across), after = mesh_.target(across);
    const std::size_t following = i + 1 < n ? i + 1 : 0;
    const Vec2 from = mesh_.point(end), corner = mesh_.point(after);
    const bool is_quad = mesh_.is_quad(QuadTopology::element(h));
    const Vec2 next = is_quad ? mesh_.point(mesh_.target(mesh_.next(across))) : corner;
    const Vec2 left = unit_along(corner - from), right = unit_along((is_quad ? corner : from) - next);
    spokes_.end_x[i] = from.x, spokes_.end_y[i] = from.y;
    spokes_.left_x[i] = left.x, spokes_.left_y[i] = left.y;
    spokes_.right_x[following] = right.x, spokes_.right_y[following] = right.y;
    spokes_.inverse_delta[i] = 2 / (delta_[v] + delta_[end]);
    ++i;
  });
}

/// Fills the rays.
template <class Number>
QuadRelocation::Lengths QuadRelocation::look_from(Vec2 at) const {
  Number shortest = Number{} + 1e300, longest{}, least_part = shortest;
  for (std::size_t i = 0; i < n_spokes_; i += kWidth<Number>) {
    const Number x = load<Number>(&spokes_.end_x[i]) - at.x, y = load<Number>(&spokes_.end_y[i]) - at.y;
    const Number length = larger(square_root(x * x + y * y), Number{} + kTinyLength), inverse = 1 / length;
    store(inverse * x, &rays_.x[i + 1]);
    store(inverse * y, &rays_.y[i + 1]);
    store(inverse, &rays_.inverse[i + 1]);
    const Number part = length * load<Number>(&spokes_.inverse_delta[i]);
    store(misfit_of(part), &rays_.misfit[i + 1]);
    shortest = smaller(shortest, length);
    longest = larger(longest, length);
    least_part = smaller(least_part, part);
  }
  for (auto* values : {&rays_.x, &rays_.y, &rays_.inverse}) (*values)[0] = (*values)[n_spokes_];
  return {least_of(shortest), -least_of(-longest), least_of(least_part)};
}

template <class Number, bool kDerivatives>
QuadRelocation::Value QuadRelocation::add_up(Derivatives* derivatives) const {
  Sums<Number, kDerivatives> sums;
  for (std::size_t i = 0; i < n_spokes_; i += kWidth<Number>) {
    const Number ux = load<Number>(&rays_.x[i + 1]), uy = load<Number>(&rays_.y[i + 1]);
    const Number px = load<Number>(&rays_.x[i]), py = load<Number>(&rays_.y[i]);
    const Number inverse = load<Number>(&rays_.inverse[i + 1]), before = load<Number>(&rays_.inverse[i]);
    const Number lx = load<Number>(&spokes_.left_x[i]), ly = load<Number>(&spokes_.left_y[i]);
    const Number rx = load<Number>(&spokes_.right_x[i]), ry = load<Number>(&spokes_.right_y[i]);
    // Gradient of the direction angle of a spoke by v: a quarter turn clockwise / length.
    const Number turn_x = inverse * uy, turn_y = -inverse * ux;
    sums.add_corner(px * uy - py * ux, px * ux + py * uy, turn_x - before * py, turn_y + before * px);
    sums.add_corner(ux * ly - uy * lx, -(ux * lx + uy * ly), turn_x, turn_y);
    sums.add_corner(rx * uy - ry * ux, -(rx * ux + ry * uy), -turn_x, -turn_y);
    sums.add_edge(ux, uy, inverse, load<Number>(&rays_.misfit[i + 1]), wall_weight_, short_misfit_,
                  long_misfit_);
  }
  if constexpr (kDerivatives)
    *derivatives = {{sum_of(sums.gx), sum_of(sums.gy)}, sum_of(sums.hxx), sum_of(sums.hxy), sum_of(sums.hyy)};
  Value value;
  value.cost = sum_of(sums.cost);
  value.least_sine = least_of(sums.least_sine);
  value.flat = static_cast<int>(sum_of(sums.flat));
  return value;
}

/// Finds directions first, then sums, so that each loop keeps its sums in registers.
template <bool kDerivatives>
QuadRelocation::Value QuadRelocation::evaluate(Vec2 at, Derivatives* derivatives) const {
  const bool even = n_spokes_ % 2 == 0;
  const Lengths lengths = even ? look_from<Pair>(at) : look_from<double>(at);
  Value value = even ? add_up<Pair, kDerivatives>(derivatives) : add_up<double, kDerivatives>(derivatives);
  value.shortest = lengths.shortest;
  const double longest = std::max(lengths.longest, longest_far_);
  value.roomy =
      lengths.least_part >= kKeptSide && std::min(lengths.shortest, shortest_far_) >= kKeptSide * longest;
  return value;
}

bool QuadRelocation::is_narrow(int element) const {
  const int n = mesh_.is_quad(element) ? 4 : 3;
  for (int k = 0; k < n; ++k)
    if (const int v = mesh_.corner(element, k); mesh_.on_boundary(v) && narrow_[v]) return true;
  return false;
}

/// Returns the crowding with a vertex at another place.
double QuadRelocation::crowding(int element, int moved, Vec2 to, double delta_there) const {
  const bool narrow = is_narrow(element);
  const int n = mesh_.is_quad(element) ? 4 : 3;
  const auto room = [&](int v) {
    if (v == moved) return delta_there;
    return mesh_.on_boundary(v) ? std::min(room_[v], delta_[v]) : delta_[v];
  };
  std::array<Vec2, 4> at;
  for (int k = 0; k < n; ++k) {
    const int v = mesh_.corner(element, k);
    at[k] = v == moved ? to : mesh_.point(v);
  }
  std::array<double, 4> lengths{};
  double double_area = 0;
  for (int k = 0; k < n; ++k) {
    const Vec2 next = at[(k + 1) % n];
    lengths[k] = norm(next - at[k]);
    double_area += cross(at[k] - at[0], next - at[0]);
  }
  const double longest = *std::ranges::max_element(lengths);
  const double width = std::max(0.0, double_area / 2) / std::max(longest, kTinyLength);
  double sum = 0;
  for (int k = 0; k < n; ++k) {
    const int h = 4 * element + k;
    if (mesh_.twin(h) < 0) continue;
    const double delta = std::min(room(mesh_.origin(h)), room(mesh_.target(h)));
    sum += crowding_of(lengths[k], delta, longest, narrow, width);
  }
  return sum;
}

/// Returns the crowding around the gathered vertex at a place.
double QuadRelocation::crowding_around(Vec2 at) const {
  const auto sum_by = [&](double delta) {
    double sum = 0;
    mesh_.for_each_out(gathered_,
                       [&](int h) { sum += crowding(QuadTopology::element(h), gathered_, at, delta); });
    return sum;
  };
  // Crowding grows with delta', which takes longer to evaluate.
  if (sum_by(std::numeric_limits<double>::max()) == 0) return 0;
  int hint = hint_[gathered_];
  return sum_by(size_.at(at, hint));
}

/// Returns whether a move brings vertices too close to each other. Angles cannot prevent it: near a place
/// where two vertices meet, the angles between them may take any value.
bool QuadRelocation::crowds(Vec2 from, Vec2 to, const Value& there) const {
  if (there.roomy) return false;
  const double crowding = crowding_around(to);
  return crowding > 0 && crowding > crowding_around(from);
}

double QuadRelocation::cost(int v) {
  gather(v);
  return evaluate<false>(mesh_.point(v), nullptr).cost;
}

/// Returns whether a step leaves its region. A convex star has its vertex in the box around the neighbors,
/// and no step may leave it. An outside vertex may move in a box twice as large, and from farther out only
/// come nearer.
bool QuadRelocation::strays(Vec2 from, Vec2 to) const {
  const Vec2 first{spokes_.end_x[0], spokes_.end_y[0]};
  Box<Vec2> box{first, first};
  for (std::size_t i = 1; i < n_spokes_; ++i) box.add({spokes_.end_x[i], spokes_.end_y[i]});
  const Vec2 middle = 0.5 * (box.low + box.high), half = 0.5 * box.size();
  // Distance from the middle; 1 on the box.
  const auto distance = [&](Vec2 p) {
    return std::max(std::abs(p.x - middle.x) / std::max(half.x, kTinyLength),
                    std::abs(p.y - middle.y) / std::max(half.y, kTinyLength));
  };
  const double before = distance(from);
  return distance(to) > (before <= 1 ? 1 : std::max(before, 2.0));
}

double QuadRelocation::step(int v) {
  check_cancelled();
  if (mesh_.on_boundary(v) || !mesh_.vertex_alive(v)) return 0;
  gather(v);
  const Vec2 at = mesh_.point(v);
  Derivatives d;
  const Value before = evaluate<true>(at, &d);
  const double determinant = d.hxx * d.hyy - d.hxy * d.hxy;
  if (!(determinant > 0)) return 0;
  Vec2 move = (-kOverRelaxation / determinant) *
              Vec2{d.hyy * d.gradient.x - d.hxy * d.gradient.y, d.hxx * d.gradient.y - d.hxy * d.gradient.x};
  const double length = norm(move), longest = kLongestStep * before.shortest;
  if (!(length > 1e-4 * before.shortest)) return 0;
  if (length > longest) move = (longest / length) * move;
  for (int halving = 0; halving < 4; ++halving, move = 0.4 * move) {
    const Value after = evaluate<false>(at + move, nullptr);
    if (!(after.cost < before.cost)) continue;
    // Checked whatever the sum gains.
    if (after.flat > (keep_convex_corners_ ? before.flat : before.flat > 0 ? after.flat : 0)) continue;
    if (after.least_sine < std::min(before.least_sine, kept_sine_)) continue;
    if (before.flat > 0 && strays(at, at + move)) continue;
    if (crowds(at, at + move, after)) continue;
    mesh_.move(v, at + move);
    return norm(move) / before.shortest;
  }
  return 0;
}

long long QuadRelocation::relax(double tolerance, int max_sweeps) {
  long long moves = 0;
  for (int sweep = 0; sweep < max_sweeps && !queue_.empty(); ++sweep) {
    visiting_.swap(queue_);
    queue_.clear();
    for (const int v : visiting_) {
      active_[v] = 0;
      if (v >= mesh_.vertex_slots() || !mesh_.vertex_alive(v)) continue;  // undone or removed since
      refresh_delta(v);
      const double moved = step(v);
      if (moved > 0) ++moves;
      if (moved > tolerance) activate_ring(v);
    }
    mesh_.commit();
  }
  for (const int v : queue_) active_[v] = 0;
  queue_.clear();
  return moves;
}

double QuadRelocation::lift(int v, double enough) {
  check_cancelled();
  if (mesh_.on_boundary(v) || !mesh_.vertex_alive(v)) return 0;
  gather(v);
  const Vec2 at = mesh_.point(v);
  Value best = evaluate<false>(at, nullptr);
  const double least = best.least_sine;
  if (least >= enough) return 0;
  Vec2 place = at;
  // Compass search for the worst corner: eight directions with a shrinking step.
  constexpr double kDiagonal = std::numbers::sqrt2 / 2;
  constexpr Vec2 kCompass[8] = {{1, 0},  {kDiagonal, kDiagonal},   {0, 1},  {-kDiagonal, kDiagonal},
                                {-1, 0}, {-kDiagonal, -kDiagonal}, {0, -1}, {kDiagonal, -kDiagonal}};
  double reach = 0.2 * best.shortest;
  for (int steps = 0; steps < kLiftSteps; ++steps) {
    const Vec2 centre = place;
    const double sine = best.least_sine;
    for (const Vec2 direction : kCompass) {
      const Vec2 there = centre + reach * direction;
      const Value trial = evaluate<false>(there, nullptr);
      if (trial.flat > best.flat || trial.least_sine <= best.least_sine || crowds(place, there, trial))
        continue;
      best = trial;
      place = there;
    }
    if (best.least_sine == sine) reach /= 2;
  }
  if (best.least_sine <= least) return 0;
  mesh_.move(v, place);
  return best.least_sine - least;
}

long long QuadRelocation::lift_worst(double eta, int max_sweeps) {
  const double sine = sine_of_eta(eta);
  long long moves = 0;
  for (int sweep = 0; sweep < max_sweeps; ++sweep) {
    long long moved = 0;
    for (int e = 0; e < mesh_.element_slots(); ++e) {
      if (!mesh_.is_quad(e) || least_sine(mesh_, e) >= sine) continue;
      for (int k = 0; k < 4; ++k)
        if (lift(mesh_.origin(4 * e + k), 1) > 1e-3) ++moved;
    }
    mesh_.commit();
    moves += moved;
    if (moved == 0) break;
  }
  return moves;
}

}  // namespace delquad
