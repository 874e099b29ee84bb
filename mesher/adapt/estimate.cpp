// SPDX-License-Identifier: GPL-3.0-or-later

#include <algorithm>
#include <cmath>

#include "base/located.h"
#include "delquad/adapt.h"
#include "mesher/adapt/elements.h"

namespace delquad {
namespace {

double along(const Tensor2& h, Vec2 d) { return h.xx * d.x * d.x + 2 * h.xy * d.x * d.y + h.yy * d.y * d.y; }

/// Places whose greatest error counts: corners of a grid with this number on a side.
constexpr int kPlaces = 4;

}  // namespace

ErrorEstimate interpolation_error(const Recovery& solution, double p) {
  if (!(p >= 1)) refuse("the norm {}: expected 1 to infinity", p);
  const ElementMaps elements(solution.mesh, true);
  ErrorEstimate estimate;
  for (int e = 0; e < elements.size(); ++e) {
    const auto v = elements.nodes(e);
    const auto n = static_cast<double>(v.size());
    Tensor2 h{0, 0, 0};
    for (const int i : v) {
      const Tensor2& at = solution.hessian[i];
      h = {h.xx + at.xx / n, h.xy + at.xy / n, h.yy + at.yy / n};
    }
    const Vec3 first = elements.points()[v[0]];
    const auto quadratic = [&](const Vec3& x) { return along(h, {x.x - first.x, x.y - first.y}) / 2; };
    const auto error = [&](const Shape& at) {
      double sum = quadratic(elements.point(e, at));
      for (std::size_t k = 0; k < v.size(); ++k) sum -= at.value[k] * quadratic(elements.points()[v[k]]);
      return std::abs(sum);
    };
    double of_element = 0;
    if (std::isinf(p)) {
      for (int i = 0; i <= kPlaces; ++i)
        for (int k = 0; k <= (elements.is_triangle(e) ? kPlaces - i : kPlaces); ++k)
          of_element =
              std::max(of_element, error(elements.shape(e, double(i) / kPlaces, double(k) / kPlaces)));
      estimate.whole = std::max(estimate.whole, of_element);
    } else {
      for (const Quadrature& q : elements.quadrature(e)) {
        Shape at = elements.shape(e, q.s, q.t);
        const double size = error(at);
        of_element += q.weight * elements.to_plane(e, at) * std::pow(size, p);
      }
      estimate.whole += of_element;
      of_element = std::pow(of_element, 1 / p);
    }
    estimate.of_elements.push_back(of_element);
  }
  if (!std::isinf(p)) estimate.whole = std::pow(estimate.whole, 1 / p);
  return estimate;
}

ErrorEstimate gradient_error(const Recovery& solution) {
  const ElementMaps elements(solution.mesh);
  ErrorEstimate estimate;
  for (int e = 0; e < elements.size(); ++e) {
    const auto v = elements.nodes(e);
    double sum = 0;
    for (const Quadrature& q : elements.quadrature(e)) {
      Shape at = elements.shape(e, q.s, q.t);
      const double area = elements.to_plane(e, at);
      Vec2 off{0, 0};
      for (std::size_t k = 0; k < v.size(); ++k)
        off += at.value[k] * solution.gradient[v[k]] -
               solution.values[v[k]] * Vec2{at.along_s[k], at.along_t[k]};
      sum += q.weight * area * dot(off, off);
    }
    estimate.whole += sum;
    estimate.of_elements.push_back(std::sqrt(sum));
  }
  estimate.whole = std::sqrt(estimate.whole);
  return estimate;
}

}  // namespace delquad
