// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <span>

#include "delquad/fields.h"

// This header has operations on metrics of a tangent plane. Metrics of features and of adaptation use it.

namespace delquad {

inline Tensor2 times(double factor, const Tensor2& m) {
  return {factor * m.xx, factor * m.xy, factor * m.yy};
}
/// Returns the determinant, but not below 0.
inline double determinant(const Tensor2& m) { return std::max(0.0, m.xx * m.yy - m.xy * m.xy); }
/// Returns whether a wants no larger lengths than b in any direction: a - b is positive semi-definite.
inline bool is_finer(const Tensor2& a, const Tensor2& b) {
  const Tensor2 d{a.xx - b.xx, a.xy - b.xy, a.yy - b.yy};
  return d.xx >= 0 && d.yy >= 0 && d.xx * d.yy >= d.xy * d.xy;
}

/// Returns |H| det(|H|)^(-1/(2p + 2)): as l2_metric(), for the Lp error, 1 <= p <= infinity [loseille2011].
Tensor2 lp_metric(const Tensor2& hessian, double p);

/// A metric of the tangent plane at a point.
struct TangentMetric {
  Vec3 e = {1, 0, 0}, f = {0, 1, 0};  ///< axes of length 1, perpendicular
  Tensor2 m = {};                     ///< tensor in these axes

  /// Returns axes across a normal of any length, with a zero tensor.
  static TangentMetric with_normal(const Vec3& normal);
  Vec2 in_plane(const Vec3& d) const { return {dot(d, e), dot(d, f)}; }
  Vec3 in_space(Vec2 d) const { return d.x * e + d.y * f; }
  /// Returns another metric in these axes, turned from its plane into this one by the least angle.
  Tensor2 seen(const TangentMetric& other) const;
};

/// Returns the square of the length of a vector that is turned into the plane; it keeps its length in space.
double metric_square(const Vec3& d, const TangentMetric& at);
/// Returns the length between places with metrics a and b, as metric_length() in delquad/fields.h.
double metric_length(const Vec3& d, const TangentMetric& a, const TangentMetric& b);
/// Returns log_mean() in the plane of the first metric [arsigny2006]. There is at least one.
TangentMetric log_mean(std::span<const TangentMetric> metrics, std::span<const double> weights);

}  // namespace delquad
