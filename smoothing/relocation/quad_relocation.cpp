#include "smoothing/relocation/quad_relocation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/box.h"
#include "base/cancel.h"

namespace delquad {

namespace {

/// Weight of the length term against the corners'.
constexpr double kLengthWeight = 0.12;
/// The steep term of a corner starts at this sine and has this factor.
constexpr double kSteepSine = 0.05, kSteep = 40;
/// Square of the misfit (logarithm of length / delta) past which the length term levels off.
constexpr double kHopeless = 2;
/// How far a step goes, in Newton's steps.
constexpr double kOverRelaxation = 1.4;
/// A step is at most this part of the shortest edge.
constexpr double kLongestStep = 0.4;
/// No step makes an edge shorter that is, or would be, shorter than this part of delta'. Angles alone do not
/// prevent it: towards a point where two vertices meet the angles between them may take any value.
constexpr double kShortest = 0.02;
/// delta' is evaluated anew after a move of this part of it.
constexpr double kDeltaReach = 0.15;
/// Steps of the search that lifts a vertex's worst corner.
constexpr int kLiftSteps = 10;

/// log(x) within 0.2 % for x from 1/2 to 2, by its Pade approximant; bounded by 3.
double misfit_of(double x) { return 3 * (x * x - 1) / (x * x + 4 * x + 1); }

Vec2 unit(Vec2 v) { return (1 / std::max(norm(v), kTinyLength)) * v; }

}  // namespace

QuadRelocation::QuadRelocation(QuadTopology& mesh, const ParametricSize& size) : mesh_(mesh), size_(size) {
  adopt_new_vertices(0);
}

void QuadRelocation::adopt_new_vertices(int first) {
  const std::size_t n = mesh_.vertex_slots();
  hint_.resize(n, -1), delta_.resize(n), delta_at_.resize(n), active_.resize(n, 0);
  for (std::size_t v = first; v < n; ++v) {
    // Neighbours lie close by, and mostly points that follow one another.
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

void QuadRelocation::gather(int v) {
  const std::size_t n = mesh_.valence(v);
  looks_ += static_cast<long long>(n);
  star_.resize(n);
  rays_.resize(n);
  std::size_t i = 0;
  mesh_.for_each_out(v, [&](int h) {
    const int across = mesh_.next(h), end = mesh_.origin(across), after = mesh_.target(across);
    const int opposite = mesh_.is_quad(QuadTopology::element(h)) ? after : end;  // of the next spoke
    star_[i] = {mesh_.point(end), mesh_.point(after), mesh_.point(opposite), 0.5 * (delta_[v] + delta_[end])};
    ++i;
  });
  Vec2 opposite = star_[n - 1].right;
  for (Spoke& spoke : star_) {
    spoke.left = unit(spoke.left - spoke.end);
    std::swap(opposite, spoke.right);
    spoke.right = unit(spoke.right - spoke.end);
  }
}

/// Directions first, then sums: each loop keeps what it adds up in registers.
template <bool kDerivatives>
QuadRelocation::Value QuadRelocation::evaluate(Vec2 at, Derivatives* derivatives) const {
  const std::size_t n = star_.size();
  Value value;
  value.shortest = 1e300;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 along = star_[i].end - at;
    const double length = std::max(norm(along), kTinyLength), inverse = 1 / length;
    rays_[i] = {inverse * along, inverse, misfit_of(length / star_[i].delta)};
    value.shortest = std::min(value.shortest, length);
  }

  double cost = 0, least_sine = 1, hxx = 0, hxy = 0, hyy = 0;
  int flat = 0;
  Vec2 gradient;
  const auto corner = [&](double sine, double cosine, Vec2 turn) {
    const double c = 1 - sine, excess = std::max(0.0, kSteepSine - sine);
    cost += c + kSteep * excess * excess;
    least_sine = std::min(least_sine, sine);
    flat += sine <= 0;
    if constexpr (kDerivatives) {
      const double slope = 1 + 2 * kSteep * excess;  // of the cost, against the sine
      const double first = -slope * cosine;
      const double second = std::max(slope * sine + (excess > 0 ? 2 * kSteep * cosine * cosine : 0), 0.1);
      gradient += first * turn;
      hxx += second * turn.x * turn.x;
      hxy += second * turn.x * turn.y;
      hyy += second * turn.y * turn.y;
    }
  };
  // Gradient of the direction angle of a spoke with respect to v: -perp(u) / length.
  Vec2 previous = rays_[n - 1].u, previous_turn = (-rays_[n - 1].inverse) * perp(previous);
  for (std::size_t i = 0; i < n; ++i) {
    const auto& [u, inverse, misfit] = rays_[i];
    const Vec2 left = star_[i].left, right = star_[i].right, turn = (-inverse) * perp(u);
    corner(cross(previous, u), dot(previous, u), turn - previous_turn);
    corner(cross(u, left), -dot(u, left), turn);
    corner(cross(right, u), -dot(right, u), -turn);
    const double soft = 1 / (1 + misfit * misfit / kHopeless);
    cost += kLengthWeight * misfit * misfit * soft;
    if constexpr (kDerivatives) {
      gradient += (-2 * kLengthWeight * misfit * soft * soft * inverse) * u;
      const double second = 2 * kLengthWeight * soft * soft * soft * inverse * inverse;
      hxx += second * u.x * u.x;
      hxy += second * u.x * u.y;
      hyy += second * u.y * u.y;
    }
    previous = u;
    previous_turn = turn;
  }
  value.cost = cost, value.least_sine = least_sine, value.flat = flat;
  if constexpr (kDerivatives) *derivatives = {gradient, hxx, hxy, hyy};
  return value;
}

double QuadRelocation::cost(int v) {
  gather(v);
  return evaluate<false>(mesh_.point(v), nullptr).cost;
}

/// A convex star has its vertex in the box around the neighbours: no step may leave that. A vertex outside
/// may go round in a box twice as large, and from farther out only come nearer.
bool QuadRelocation::strays(Vec2 from, Vec2 to) const {
  Box<Vec2> box{star_[0].end, star_[0].end};
  for (const Spoke& spoke : star_) box.add(spoke.end);
  const Vec2 middle = 0.5 * (box.low + box.high), half = 0.5 * box.size();
  // Distance from the middle: 1 on the box.
  const auto distance = [&](Vec2 p) {
    return std::max(std::abs(p.x - middle.x) / std::max(half.x, kTinyLength),
                    std::abs(p.y - middle.y) / std::max(half.y, kTinyLength));
  };
  const double before = distance(from);
  return distance(to) > (before <= 1 ? 1 : std::max(before, 2.0));
}

bool QuadRelocation::shrinks(int v, const Value& before, const Value& after) const {
  return after.shortest < std::min(before.shortest, kShortest * delta_[v]);
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
    // Whatever the sum gains.
    if (after.flat > (keep_convex_corners_ ? before.flat : before.flat > 0 ? after.flat : 0)) continue;
    if (after.least_sine < std::min(before.least_sine, kept_sine_)) continue;
    if (before.flat > 0 && strays(at, at + move)) continue;
    if (shrinks(v, before, after)) continue;
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
      if (v >= mesh_.vertex_slots() || !mesh_.vertex_alive(v)) continue;  // since taken back, or removed
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
  // Compass search for the worst corner: eight directions, a step that shrinks.
  constexpr double kDiagonal = std::numbers::sqrt2 / 2;
  constexpr Vec2 kCompass[8] = {{1, 0},  {kDiagonal, kDiagonal},   {0, 1},  {-kDiagonal, kDiagonal},
                                {-1, 0}, {-kDiagonal, -kDiagonal}, {0, -1}, {kDiagonal, -kDiagonal}};
  double reach = 0.2 * best.shortest;
  for (int steps = 0; steps < kLiftSteps; ++steps) {
    const Vec2 centre = place;
    const double sine = best.least_sine;
    for (const Vec2 direction : kCompass) {
      const Value trial = evaluate<false>(centre + reach * direction, nullptr);
      if (trial.flat > best.flat || trial.least_sine <= best.least_sine || shrinks(v, best, trial)) continue;
      best = trial;
      place = centre + reach * direction;
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
