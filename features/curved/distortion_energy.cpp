#include "features/curved/distortion_energy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "base/cancel.h"
#include "geometry/mesh/element_nodes.h"

namespace delquad {

namespace {

/// What counts as hardly positive: det T below this, or below this part of the least one where all are
/// positive, so that they stay so.
constexpr double kSoftness = 0.05, kSoftPart = 0.2;
/// Places at which an element's distortion is measured, along each side.
constexpr int kSamples = 7;

}  // namespace

SampleTable make_sample_table(int order) {
  const auto values = [&](double t) {
    std::vector<std::array<double, 2>> result;  // value and derivative of each node's polynomial
    for (int i = 0; i <= order; ++i) {
      double value = 1, slope = 0;
      for (int k = 0; k <= order; ++k) {
        if (k == i) continue;
        const double over = static_cast<double>(i - k) / order,
                     factor = (t - static_cast<double>(k) / order) / over;
        slope = slope * factor + value / over;
        value *= factor;
      }
      result.push_back({value, slope});
    }
    return result;
  };
  SampleTable table;
  for (int b = 0; b < kSamples; ++b)
    for (int a = 0; a < kSamples; ++a) {
      const auto fu = values(static_cast<double>(a) / (kSamples - 1)),
                 fv = values(static_cast<double>(b) / (kSamples - 1));
      std::vector<double> du, dv;
      for (int j = 0; j <= order; ++j)
        for (int i = 0; i <= order; ++i) {
          du.push_back(fu[i][1] * fv[j][0]);
          dv.push_back(fu[i][0] * fv[j][1]);
        }
      table.du.push_back(std::move(du));
      table.dv.push_back(std::move(dv));
    }
  return table;
}

bool make_target(const Mesh& mesh, std::size_t quad, Likeness likeness, DistortionTarget& target) {
  target.nodes = nodes_of_quad(mesh, quad);
  const auto& v = mesh.quads[quad];
  const auto at = [&](int k) { return mesh.points[v[k]]; };
  const Vec3 a = 0.5 * (at(1) - at(0) + at(2) - at(3)), b = 0.5 * (at(3) - at(0) + at(2) - at(1));
  const Vec3 n = cross(a, b);
  if (!(norm(n) > 1e-9 * norm(a) * norm(b))) return false;
  target.e1 = (1 / norm(a)) * a;
  target.e2 = cross((1 / norm(n)) * n, target.e1);
  double x = norm(a), y = dot(b, target.e1), z = dot(b, target.e2);
  if (likeness == Likeness::kRightAngled) {
    const auto side = [&](int k) { return norm(at((k + 1) % 4) - at(k)); };
    x = (side(0) + side(2)) / 2, y = 0, z = (side(1) + side(3)) / 2;
  }
  target.inverse = {1 / x, -y / (x * z), 0, 1 / z};
  return true;
}

DistortionEnergy::DistortionEnergy(const std::vector<Vec3>& points,
                                   const std::vector<DistortionTarget>& targets,
                                   const std::vector<FreeNode>& free, const SampleTable& table,
                                   DistortionWeights weights)
    : points_(points), targets_(targets), free_(free), table_(table), weights_(weights) {
  std::map<int, int> index;
  for (std::size_t i = 0; i < free.size(); ++i) index[free[i].node] = static_cast<int>(i);
  for (const DistortionTarget& target : targets_) {
    std::vector<int>& of = free_of_.emplace_back();
    for (const int node : target.nodes) {
      const auto found = index.find(node);
      of.push_back(found == index.end() ? -1 : found->second);
    }
  }
  const std::vector<double> start(2 * free.size(), 0);
  double least = 1;
  for (std::size_t t = 0; t < targets_.size(); ++t) {
    const Flat nodes = nodes_in_plane(t, start.data());
    for (std::size_t s = 0; s < table_.du.size(); ++s) {
      const auto [p, q] = columns(targets_[t], nodes, s);
      least = std::min(least, cross(p, q));
    }
  }
  softness_ = least > 0 ? std::min(kSoftPart * least, kSoftness) : kSoftness;
}

bool DistortionEnergy::Evaluate(const double* x, double* cost, double* gradient) const {
  if (is_cancelled()) return false;
  *cost = 0;
  if (gradient != nullptr) std::fill_n(gradient, NumParameters(), 0.0);
  for (std::size_t t = 0; t < targets_.size(); ++t) add(t, x, *cost, gradient);
  return std::isfinite(*cost);
}

DistortionEnergy::Flat DistortionEnergy::nodes_in_plane(std::size_t target, const double* x) const {
  const DistortionTarget& t = targets_[target];
  Flat flat{};
  for (std::size_t i = 0; i < t.nodes.size(); ++i) {
    Vec3 p = points_[t.nodes[i]];
    if (const int f = free_of_[target][i]; f >= 0)
      p = p + x[2 * f] * free_[f].axes[0] + x[2 * f + 1] * free_[f].axes[1];
    flat.x[i] = dot(p, t.e1), flat.y[i] = dot(p, t.e2);
  }
  return flat;
}

/// Columns of T: those of the element's map times the inverse of the target's.
std::array<Vec2, 2> DistortionEnergy::columns(const DistortionTarget& t, const Flat& flat,
                                              std::size_t sample) const {
  Vec2 xu, xv;
  const double *du = table_.du[sample].data(), *dv = table_.dv[sample].data();
  for (std::size_t i = 0; i < t.nodes.size(); ++i) {
    xu.x += du[i] * flat.x[i], xu.y += du[i] * flat.y[i];
    xv.x += dv[i] * flat.x[i], xv.y += dv[i] * flat.y[i];
  }
  const auto& [m00, m01, m10, m11] = t.inverse;
  return {m00 * xu + m10 * xv, m01 * xu + m11 * xv};
}

void DistortionEnergy::add(std::size_t target, const double* x, double& cost, double* gradient) const {
  const DistortionTarget& t = targets_[target];
  const std::size_t n = t.nodes.size();
  const Flat flat = nodes_in_plane(target, x);
  Flat slope{};
  const auto& [m00, m01, m10, m11] = t.inverse;
  const double shape = weights_.shape;
  for (std::size_t s = 0; s < table_.du.size(); ++s) {
    const auto [p, q] = columns(t, flat, s);
    const double pp = dot(p, p), qq = dot(q, q), lengths = std::sqrt(pp * qq);
    const double det = cross(p, q), root = std::sqrt(det * det + softness_ * softness_);
    const double soft = (det + root) / 2;
    const double distortion = (shape * (pp + qq) / 2 + (1 - shape) * lengths) / soft;
    const double power = std::pow(distortion, weights_.power - 1);
    cost += power * distortion;
    if (gradient == nullptr) continue;
    const double outer = weights_.power * power;
    const double by_det = -distortion / soft * (1 + det / root) / 2;
    const double of_p = pp > 0 ? (1 - shape) * lengths / pp : 0,
                 of_q = qq > 0 ? (1 - shape) * lengths / qq : 0;
    const Vec2 by_p = outer * ((shape + of_p) / soft * p + by_det * Vec2{q.y, -q.x});
    const Vec2 by_q = outer * ((shape + of_q) / soft * q + by_det * Vec2{-p.y, p.x});
    const Vec2 by_u = m00 * by_p + m01 * by_q, by_v = m10 * by_p + m11 * by_q;
    const double *du = table_.du[s].data(), *dv = table_.dv[s].data();
    for (std::size_t i = 0; i < n; ++i) {
      slope.x[i] += du[i] * by_u.x + dv[i] * by_v.x;
      slope.y[i] += du[i] * by_u.y + dv[i] * by_v.y;
    }
  }
  if (gradient == nullptr) return;
  for (std::size_t i = 0; i < n; ++i) {
    const int f = free_of_[target][i];
    if (f < 0) continue;
    const Vec3 in_space = slope.x[i] * t.e1 + slope.y[i] * t.e2;
    for (const int k : {0, 1}) gradient[2 * f + k] += dot(in_space, free_[f].axes[k]);
  }
}

}  // namespace delquad
