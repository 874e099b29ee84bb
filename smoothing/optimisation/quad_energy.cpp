#include "smoothing/optimisation/quad_energy.h"

#include <algorithm>
#include <cmath>

#include "smoothing/optimisation/quad_corners.h"

namespace delquad {

namespace {

/// Where |angle - 90 degrees| (radians) and |log(l/d)| are rounded off.
constexpr double kShapeKink = 0.03, kSizeKink = 0.02;

double power(double x, int n) {
  double result = 1;
  for (; n > 0; --n) result *= x;
  return result;
}

}  // namespace

template <class Vec>
QuadEnergy<Vec>::QuadEnergy(QuadEnergyMesh<Vec> mesh, const QuadEnergyWeights& weights)
    : weights_(weights),
      start_(std::move(mesh.points)),
      moving_(std::move(mesh.moving)),
      at_(start_),
      slope_(start_.size()) {
  std::vector<char> moves(start_.size(), 0);
  for (const auto& m : moving_) moves[m.vertex] = 1;
  struct Side {
    int a, b, quad, k;
  };
  std::vector<Side> sides;
  for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
    const auto& v = mesh.quads[q];
    if (std::none_of(v.begin(), v.end(), [&](int i) { return moves[i]; })) continue;
    unsigned movable = 0;
    for (int k = 0; k < 4; ++k)
      if (moves[v[(k + 3) % 4]] || moves[v[k]] || moves[v[(k + 1) % 4]]) movable |= 1U << k;
    quads_.push_back({v, movable, quad_normal(start_[v[2]] - start_[v[0]], start_[v[3]] - start_[v[1]]),
                      mesh.least_sine[q], mesh.weight[q]});
    for (int k = 0; k < 4; ++k) {
      const int a = v[k], b = v[(k + 1) % 4];
      if (moves[a] || moves[b]) sides.push_back({std::min(a, b), std::max(a, b), static_cast<int>(q), k});
    }
  }
  std::stable_sort(sides.begin(), sides.end(),
                   [](const Side& s, const Side& t) { return s.a != t.a ? s.a < t.a : s.b < t.b; });
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const auto& [a, b, quad, k] = sides[i];
    if (i > 0 && sides[i - 1].a == a && sides[i - 1].b == b) continue;
    edges_.push_back(
        {a, b, 2 / (mesh.delta[a] + mesh.delta[b]), mesh.least_lengths[quad][k], mesh.arm(quad, k)});
  }
}

template <class Vec>
void QuadEnergy<Vec>::place(const double* x, std::vector<Vec>& at) const {
  for (const auto& [vertex, axes] : moving_) {
    at[vertex] = start_[vertex] + (x[0] * axes[0] + x[1] * axes[1]);
    x += 2;
  }
}

template <class Vec>
std::vector<Vec> QuadEnergy<Vec>::points(const double* x) const {
  std::vector<Vec> at = start_;
  place(x, at);
  return at;
}

template <class Vec>
bool QuadEnergy<Vec>::evaluate(const double* x, double& energy, double* gradient) const {
  place(x, at_);
  energy = 0;
  if (gradient == nullptr) return add_all<false>(energy);
  std::fill(slope_.begin(), slope_.end(), Vec{});
  if (!add_all<true>(energy)) return false;
  for (const auto& [vertex, axes] : moving_) {
    *gradient++ = dot(axes[0], slope_[vertex]);
    *gradient++ = dot(axes[1], slope_[vertex]);
  }
  return true;
}

template <class Vec>
template <bool kSlope>
bool QuadEnergy<Vec>::add_all(double& energy) const {
  for (const Quad& quad : quads_)
    if (!add_quad<kSlope>(quad, energy)) return false;
  for (const Edge& edge : edges_)
    if (!add_edge<kSlope>(edge, energy)) return false;
  return std::isfinite(energy);
}

template <class Vec>
template <bool kSlope>
bool QuadEnergy<Vec>::add_quad(const Quad& quad, double& energy) const {
  const auto& v = quad.vertices;
  Vec side[4];  // unit vectors
  double inverse[4];
  for (int k = 0; k < 4; ++k) {
    side[k] = at_[v[(k + 1) % 4]] - at_[v[k]];
    inverse[k] = 1 / norm(side[k]);
    side[k] = inverse[k] * side[k];
  }
  const QuadCorner<Vec> corner[4] = {{side[3], side[0], quad.normal},
                                     {side[0], side[1], quad.normal},
                                     {side[1], side[2], quad.normal},
                                     {side[2], side[3], quad.normal}};
  double shape = kShapeKink * kShapeKink / 2, clearance = 1;
  for (int k = 0; k < 4; ++k) {
    if (!quad.moves(k)) continue;
    if (!(corner[k].sine > quad.least_sine)) return false;
    shape += 1 / corner[k].sine - 1;
    clearance *= corner[k].sine - quad.least_sine;
  }
  if (weights_.barrier > 0) energy -= weights_.barrier * std::log(clearance);
  const double good = quad.weight * std::sqrt(shape),
               bad = quad.weight * weights_.bad * power(shape, weights_.bad_power);
  energy += good + bad;
  if constexpr (!kSlope) return true;
  const double steep = (0.5 * good + weights_.bad_power * bad) / shape;
  for (int k = 0; k < 4; ++k) {
    if (!quad.moves(k)) continue;
    const int before = (k + 3) % 4;
    const double sine = corner[k].sine;
    const double by_sine = -steep / (sine * sine) - weights_.barrier / (sine - quad.least_sine);
    // The sine's derivative by the angle between both sides is their cosine.
    const double by_turn = by_sine * dot(side[before], side[k]);
    const Vec first = by_turn * inverse[before] * corner[k].quarter_turn(side[before]);
    const Vec second = by_turn * inverse[k] * corner[k].quarter_turn(side[k]);
    slope_[v[k]] = slope_[v[k]] - first - second;
    slope_[v[before]] = slope_[v[before]] + first;
    slope_[v[(k + 1) % 4]] = slope_[v[(k + 1) % 4]] + second;
  }
  return true;
}

template <class Vec>
template <bool kSlope>
bool QuadEnergy<Vec>::add_edge(const Edge& edge, double& energy) const {
  const Vec along = at_[edge.b] - at_[edge.a];
  const double length = norm(along), inverse = 1 / length;
  if (!(length > edge.least_length)) return false;
  const double misfit = std::log(length * edge.inverse_length);
  const double rounded = std::sqrt(misfit * misfit + kSizeKink * kSizeKink),
               lack = std::exp(kSizeKink - rounded);
  const Vec u = inverse * along;
  // sin^2 2 phi = 4 c^2 (1 - c^2), c the cosine between edge and arm.
  const double c = dot(u, edge.arm), c2 = c * c;
  const double too_short = weights_.barrier * edge.least_length / (length - edge.least_length);
  energy += weights_.size * (1 - lack) + 4 * weights_.alignment * c2 * (1 - c2) + too_short;
  if constexpr (!kSlope) return true;
  const double by_length =
      weights_.size * lack * misfit / rounded * inverse - too_short / (length - edge.least_length);
  const double by_cosine = 8 * weights_.alignment * c * (1 - 2 * c2) * inverse;
  const Vec by_end = by_length * u + by_cosine * (edge.arm - c * u);
  slope_[edge.b] = slope_[edge.b] + by_end;
  slope_[edge.a] = slope_[edge.a] - by_end;
  return true;
}

template class QuadEnergy<Vec2>;
template class QuadEnergy<Vec3>;

}  // namespace delquad
