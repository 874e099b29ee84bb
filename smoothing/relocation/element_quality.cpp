// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/relocation/element_quality.h"

#include <limits>

namespace delquad {

namespace {

constexpr double kSizeWeight = 1.5;

}  // namespace

ElementQuality quality_of(const std::array<Vec2, 4>& at, const std::array<double, 4>& delta,
                          const QuadLimits& limits, int n) {
  std::array<Vec2, 4> side;
  double deviation = 0, shortest_side = std::numeric_limits<double>::max(), longest_side = 0;
  double shortest = shortest_side, longest = 0;  // over delta'
  for (int k = 0; k < n; ++k) {
    const int next = k + 1 < n ? k + 1 : 0;
    const Vec2 along = at[next] - at[k];
    const double length = norm(along), l = length / (0.5 * (delta[k] + delta[next]));
    deviation += 1 - std::min(l, 1 / l);
    shortest = std::min(shortest, l), longest = std::max(longest, l);
    shortest_side = std::min(shortest_side, length), longest_side = std::max(longest_side, length);
    side[k] = (1 / std::max(length, kTinyLength)) * along;
  }
  double least = std::min(1.0, cross(side[n - 1], side[0]));
  for (int k = 1; k < n; ++k) least = std::min(least, cross(side[k - 1], side[k]));
  const double aspect = longest_side / std::max(shortest_side, kTinyLength);
  const bool is_failing = is_beyond(limits, shortest, longest, aspect, least);
  const bool is_thin = shortest < limits.shortest || aspect > limits.aspect;
  const bool roomy = shortest >= kKeptSide && shortest_side >= kKeptSide * longest_side;
  return {eta_of_sine(least) - kSizeWeight * (deviation / n), least, is_failing, is_thin, roomy ? 0.0 : 1.0};
}

ElementQuality element_quality(const QuadTopology& mesh, const QuadRelocation& relocation, int element) {
  const int n = mesh.is_quad(element) ? 4 : 3;
  std::array<Vec2, 4> at;
  std::array<double, 4> delta;
  for (int k = 0; k < n; ++k) {
    const int v = mesh.corner(element, k);
    at[k] = mesh.point(v), delta[k] = relocation.delta(v);
  }
  ElementQuality quality = quality_of(at, delta, relocation.limits(), n);
  if (quality.crowding > 0) quality.crowding = relocation.crowding(element);
  return quality;
}

}  // namespace delquad
