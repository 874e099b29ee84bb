// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

#include "algorithms/fields/tangent_metric.h"
#include "delquad/fields.h"

namespace delquad {
namespace {

/// Eigenvalues, the larger one first, and its direction.
struct Spectrum {
  double most, least;
  Vec2 direction;
};

/// Returns the spectrum; the smaller eigenvalue is from the determinant, so that it keeps its digits.
Spectrum spectrum(const Tensor2& m) {
  const double mean = (m.xx + m.yy) / 2, half = (m.xx - m.yy) / 2, radius = std::hypot(half, m.xy);
  const double most = mean + radius, det = m.xx * m.yy - m.xy * m.xy;
  const double theta = radius > 0 ? std::atan2(m.xy, half) / 2 : 0;
  return {most, most > 0 ? det / most : mean - radius, {std::cos(theta), std::sin(theta)}};
}

Tensor2 tensor_by(double along, double across, Vec2 e) {
  return {along * e.x * e.x + across * e.y * e.y, (along - across) * e.x * e.y,
          along * e.y * e.y + across * e.x * e.x};
}

template <class F>
Tensor2 map_spectrum(const Tensor2& m, F&& f) {
  const Spectrum s = spectrum(m);
  return tensor_by(f(s.most), f(s.least), s.direction);
}

/// Relative difference below which two lengths count as equal; their mean is then exact to rounding.
constexpr double kEqualLengths = 1e-5;

}  // namespace

Tensor2 tensor_of(const MetricAxes& axes) {
  return tensor_by(1 / (axes.h1 * axes.h1), 1 / (axes.h2 * axes.h2),
                   {std::cos(axes.theta), std::sin(axes.theta)});
}

MetricAxes axes_of(const Tensor2& m) {
  const Spectrum s = spectrum(m);
  return {1 / std::sqrt(s.most), 1 / std::sqrt(s.least), std::atan2(s.direction.y, s.direction.x)};
}

bool is_metric(const Tensor2& m) {
  if (!std::isfinite(m.xx) || !std::isfinite(m.xy) || !std::isfinite(m.yy)) return false;
  const Spectrum s = spectrum(m);
  return s.least > 0 && std::isfinite(s.most) && s.most < kMostAspect * kMostAspect * s.least;
}

double metric_length(Vec2 d, const Tensor2& a, const Tensor2& b) {
  const auto by = [&](const Tensor2& m) {
    return std::sqrt(std::max(0.0, m.xx * d.x * d.x + 2 * m.xy * d.x * d.y + m.yy * d.y * d.y));
  };
  const double la = by(a), lb = by(b);
  if (!(std::abs(la - lb) > kEqualLengths * (la + lb))) return (la + lb) / 2;
  return (la - lb) / std::log(la / lb);
}

double difference(const Tensor2& a, const Tensor2& b) {
  // Half the logarithms of the eigenvalues of a^-1 b, from their product and sum.
  const double det = determinant(b) / determinant(a);
  const double half = (a.yy * b.xx - 2 * a.xy * b.xy + a.xx * b.yy) / determinant(a) / 2;
  const double root = std::sqrt(std::max(0.0, half * half - det)), most = half + root;
  return std::max(std::abs(std::log(most)), std::abs(std::log(det / most))) / 2;
}

Tensor2 intersection(const Tensor2& a, const Tensor2& b) {
  // In the coordinates y = sqrt(a) x the first is the identity, and the axes of the second are the common
  // ones.
  const Tensor2 root = map_spectrum(a, [](double v) { return std::sqrt(v); });
  const Tensor2 back = map_spectrum(a, [](double v) { return 1 / std::sqrt(v); });
  const auto congruent = [](const Tensor2& s, const Tensor2& m) {
    const double p = s.xx * m.xx + s.xy * m.xy, q = s.xx * m.xy + s.xy * m.yy;
    const double r = s.xy * m.xx + s.yy * m.xy, t = s.xy * m.xy + s.yy * m.yy;
    return Tensor2{p * s.xx + q * s.xy, p * s.xy + q * s.yy, r * s.xy + t * s.yy};
  };
  const Tensor2 least = map_spectrum(congruent(back, b), [](double v) { return std::max(1.0, v); });
  return congruent(root, least);
}

Tensor2 log_mean(std::span<const Tensor2> tensors, std::span<const double> weights) {
  assert(tensors.size() == weights.size());
  Tensor2 sum{0, 0, 0};
  for (std::size_t i = 0; i < tensors.size(); ++i) {
    const Tensor2 log = map_spectrum(tensors[i], [](double v) { return std::log(v); });
    sum = {sum.xx + weights[i] * log.xx, sum.xy + weights[i] * log.xy, sum.yy + weights[i] * log.yy};
  }
  // Eigenvalues of a logarithm have any sign.
  const double mean = (sum.xx + sum.yy) / 2, half = (sum.xx - sum.yy) / 2, radius = std::hypot(half, sum.xy);
  const double theta = radius > 0 ? std::atan2(sum.xy, half) / 2 : 0;
  return tensor_by(std::exp(mean + radius), std::exp(mean - radius), {std::cos(theta), std::sin(theta)});
}

Tensor2 grown(const Tensor2& m, double length, double gradation) {
  assert(gradation > 1);
  const double factor = 1 + length * std::log(gradation), scale = 1 / (factor * factor);
  return {scale * m.xx, scale * m.xy, scale * m.yy};
}

Tensor2 l2_metric(const Tensor2& hessian) { return lp_metric(hessian, 2); }

Tensor2 lp_metric(const Tensor2& hessian, double p) {
  constexpr double kLeast = 1e-6, kTiny = 1e-100;
  const double mean = (hessian.xx + hessian.yy) / 2, half = (hessian.xx - hessian.yy) / 2;
  const double radius = std::hypot(half, hessian.xy);
  const double theta = radius > 0 ? std::atan2(hessian.xy, half) / 2 : 0;
  double along = std::abs(mean + radius), across = std::abs(mean - radius);
  const double least = std::max(kLeast * std::max(along, across), kTiny);
  along = std::max(along, least);
  across = std::max(across, least);
  // The determinant is too small where one curvature changes its sign.
  constexpr double kLeastInFactor = 1e-3;
  const double most = std::max(along, across);
  const double factor = std::pow(std::max(along * across, kLeastInFactor * most * most), -1 / (2 * p + 2));
  return tensor_by(factor * along, factor * across, {std::cos(theta), std::sin(theta)});
}

Tensor2 limited(const Tensor2& m, const MetricLimits& limits) {
  Spectrum s = spectrum(m);
  const double most = limits.min > 0 ? 1 / (limits.min * limits.min) : std::numeric_limits<double>::max();
  const double least = limits.max > 0 ? 1 / (limits.max * limits.max) : 0;
  s.most = std::min(std::max(s.most, least), most);
  s.least = std::min(std::max(s.least, least), most);
  if (limits.aspect > 0) s.least = std::max(s.least, s.most / (limits.aspect * limits.aspect));
  return tensor_by(s.most, s.least, s.direction);
}

TangentMetric TangentMetric::with_normal(const Vec3& normal) {
  const double length = norm(normal);
  const Vec3 n = length > 0 ? (1 / length) * normal : Vec3{0, 0, 1};
  // Away from the axis that is nearest to the normal.
  const Vec3 axis = std::abs(n.x) < std::abs(n.y) ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 e = cross(axis, n);
  TangentMetric metric{(1 / norm(e)) * e, {}, {}};
  metric.f = cross(n, metric.e);
  return metric;
}

Tensor2 TangentMetric::seen(const TangentMetric& other) const {
  if (e == other.e && f == other.f) return other.m;  // in flat faces
  constexpr double kOpposite = 1e-6;                 // 1 + cosine
  const Vec3 n = cross(e, f), o = cross(other.e, other.f);
  const double cosine = 1 + dot(n, o);
  const Vec3 turned = cosine > kOpposite ? other.e - (dot(other.e, n) / cosine) * (n + o) : other.e;
  const Vec2 x = in_plane(turned);
  const double length = norm(x), c = length > 0 ? x.x / length : 1, s = length > 0 ? x.y / length : 0;
  const auto& [xx, xy, yy] = other.m;
  return {c * c * xx - 2 * c * s * xy + s * s * yy, c * s * (xx - yy) + (c * c - s * s) * xy,
          s * s * xx + 2 * c * s * xy + c * c * yy};
}

double metric_square(const Vec3& d, const TangentMetric& at) {
  const Vec2 x = at.in_plane(d);
  const double flat = dot(x, x), by = at.m.xx * x.x * x.x + 2 * at.m.xy * x.x * x.y + at.m.yy * x.y * x.y;
  // A direction across the plane takes the mean over all directions.
  constexpr double kUpright = 1e-12;
  if (!(flat > kUpright * dot(d, d))) return dot(d, d) * (at.m.xx + at.m.yy) / 2;
  return std::max(0.0, by) * dot(d, d) / flat;
}

double metric_length(const Vec3& d, const TangentMetric& a, const TangentMetric& b) {
  return metric_length(Vec2{1, 0}, Tensor2{metric_square(d, a), 0, 1}, Tensor2{metric_square(d, b), 0, 1});
}

TangentMetric log_mean(std::span<const TangentMetric> metrics, std::span<const double> weights) {
  TangentMetric mean = metrics[0];
  std::vector<Tensor2> seen;
  for (const TangentMetric& m : metrics) seen.push_back(mean.seen(m));
  mean.m = log_mean(seen, weights);
  return mean;
}

}  // namespace delquad
