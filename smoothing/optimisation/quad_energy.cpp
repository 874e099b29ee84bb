#include "smoothing/optimisation/quad_energy.h"

#include <algorithm>
#include <cmath>

namespace delquad {

namespace {

/// Where |angle - 90 degrees| (radians) and |log(l/d)| are rounded off.
constexpr double kShapeKink = 0.03, kSizeKink = 0.02;

}  // namespace

QuadEnergy::QuadEnergy(const QuadPatch& mesh, const std::vector<char>& free, const std::vector<double>& delta,
                       const std::vector<Cross>& cross, double least_sine, const QuadEnergyWeights& weights)
    : weights_(weights), least_sine_(least_sine), start_(mesh.points) {
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    if (free[v]) free_.push_back(static_cast<int>(v)), scale_.push_back(delta[v]);
  std::vector<std::array<int, 2>> sides;
  for (const auto& quad : mesh.quads) {
    if (std::none_of(quad.begin(), quad.end(), [&](int v) { return free[v]; })) continue;
    unsigned movable = 0;
    for (int k = 0; k < 4; ++k)
      if (free[quad[(k + 3) % 4]] || free[quad[k]] || free[quad[(k + 1) % 4]]) movable |= 1U << k;
    quads_.push_back({quad, movable});
    for (int k = 0; k < 4; ++k) {
      const int a = quad[k], b = quad[(k + 1) % 4];
      if (free[a] || free[b]) sides.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::sort(sides.begin(), sides.end());
  sides.erase(std::unique(sides.begin(), sides.end()), sides.end());
  for (const auto& [a, b] : sides) {
    const Cross mean = cross[a] + cross[b];
    const double n = std::hypot(mean.c, mean.s);
    const Cross unit = n > 0 ? Cross{mean.c / n, mean.s / n} : Cross{0, 0};
    edges_.push_back({a, b, (delta[a] + delta[b]) / 2, unit});
  }
}

std::vector<Vec2> QuadEnergy::points(const double* displacement) const {
  std::vector<Vec2> at = start_;
  for (std::size_t i = 0; i < free_.size(); ++i)
    at[free_[i]] += scale_[i] * Vec2{displacement[2 * i], displacement[2 * i + 1]};
  return at;
}

bool QuadEnergy::evaluate(const double* displacement, double& energy, double* gradient) const {
  const std::vector<Vec2> at = points(displacement);
  std::vector<Vec2> slope;
  if (gradient != nullptr) slope.resize(at.size());
  std::vector<Vec2>* const target = gradient != nullptr ? &slope : nullptr;
  energy = 0;
  for (const Quad& quad : quads_)
    if (!add_quad(quad, at, energy, target)) return false;
  for (const Edge& edge : edges_) add_edge(edge, at, energy, target);
  if (!std::isfinite(energy)) return false;
  for (std::size_t i = 0; gradient != nullptr && i < free_.size(); ++i) {
    gradient[2 * i] = scale_[i] * slope[free_[i]].x;
    gradient[2 * i + 1] = scale_[i] * slope[free_[i]].y;
  }
  return true;
}

bool QuadEnergy::add_quad(const Quad& quad, const std::vector<Vec2>& at, double& energy,
                          std::vector<Vec2>* slope) const {
  const auto& v = quad.vertices;
  Vec2 side[4];  // unit vectors
  double inverse[4], sine[4];
  for (int k = 0; k < 4; ++k) {
    side[k] = at[v[(k + 1) % 4]] - at[v[k]];
    inverse[k] = 1 / norm(side[k]);
    side[k] = inverse[k] * side[k];
  }
  double shape = kShapeKink * kShapeKink / 2, clearance = 1;
  for (int k = 0; k < 4; ++k) {
    if (!quad.moves(k)) continue;
    sine[k] = cross(side[(k + 3) % 4], side[k]);
    if (!(sine[k] > least_sine_)) return false;
    shape += 1 / sine[k] - 1;
    clearance *= sine[k] - least_sine_;
  }
  energy -= weights_.barrier * std::log(clearance);
  const double good = std::sqrt(shape), bad = weights_.bad * std::pow(shape, weights_.bad_power);
  energy += good + bad;
  if (slope == nullptr) return true;
  const double steep = (0.5 * good + weights_.bad_power * bad) / shape;
  for (int k = 0; k < 4; ++k) {
    if (!quad.moves(k)) continue;
    const int before = (k + 3) % 4;
    const double by_sine = -steep / (sine[k] * sine[k]) - weights_.barrier / (sine[k] - least_sine_);
    // The sine's derivative by the angle between both sides is their cosine.
    const double by_turn = by_sine * dot(side[before], side[k]);
    const Vec2 first = by_turn * inverse[before] * perp(side[before]);
    const Vec2 second = by_turn * inverse[k] * perp(side[k]);
    (*slope)[v[k]] += -first - second;
    (*slope)[v[before]] += first;
    (*slope)[v[(k + 1) % 4]] += second;
  }
  return true;
}

void QuadEnergy::add_edge(const Edge& edge, const std::vector<Vec2>& at, double& energy,
                          std::vector<Vec2>* slope) const {
  const Vec2 along = at[edge.b] - at[edge.a];
  const double length = norm(along), misfit = std::log(length / edge.length);
  const double rounded = std::sqrt(misfit * misfit + kSizeKink * kSizeKink),
               lack = std::exp(kSizeKink - rounded);
  energy += weights_.size * (1 - lack);
  const Vec2 u = (1 / length) * along;
  const Cross direction = Cross::along(u);
  energy += weights_.alignment * (1 - direction.c * edge.cross.c - direction.s * edge.cross.s) / 2;
  if (slope == nullptr) return;
  const double by_length = weights_.size * lack * misfit / rounded / length;
  const double by_angle =
      2 * weights_.alignment * (direction.s * edge.cross.c - direction.c * edge.cross.s) / length;
  const Vec2 by_end = by_length * u + by_angle * perp(u);
  (*slope)[edge.b] += by_end;
  (*slope)[edge.a] += -by_end;
}

}  // namespace delquad
