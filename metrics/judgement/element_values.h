// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "metrics/shape.h"

// This header has the value of an element for each criterion. The judges of elements use it.

namespace delquad {

/// Criteria in the order of criterion_registry().
enum CriterionKind {
  kMinLength,
  kMaxLength,
  kMinHeight,
  kMaxAspect,
  kMinAngle,
  kMaxAngle,
  kMaxWarpage,
  kMinJacobian,
  kMinGaussRatio,
  kMaxSkew,
  kMaxTaper,
  kMinTimeStep,
  kMinEta,
};

/// Program whose length sets the time step of a shell.
enum class StepLength { kLsDyna, kRadioss, kAbaqus };

/// Returns the shortest and the longest side.
template <size_t N>
std::pair<double, double> least_and_most_side(const std::array<Vec3, N>& p) {
  double least = norm(p[0] - p[N - 1]), most = least;
  for (size_t k = 1; k < N; ++k) {
    const double side = norm(p[k] - p[k - 1]);
    least = std::min(least, side);
    most = std::max(most, side);
  }
  return {least, most};
}

/// Returns the least distance of a corner from the line through a side that does not end there.
template <size_t N>
double least_height(const std::array<Vec3, N>& p) {
  double least = std::numeric_limits<double>::infinity();
  for (size_t k = 0; k < N; ++k) {
    const Vec3 side = p[(k + 1) % N] - p[k];
    for (size_t j = 2; j < N; ++j)
      least = std::min(least, norm(cross(side, p[(k + j) % N] - p[k])) / norm(side));
  }
  return least;
}

/// Returns least over largest Jacobian of the bilinear quad at 2 x 2 Gauss points, seen along its area
/// vector; at most 1. It is negative if the quad is inverted at one, and 0 if no Jacobian is positive.
inline double gauss_ratio(const std::array<Vec3, 4>& p) {
  const Vec3 normal = area_vector(p);
  double least = std::numeric_limits<double>::infinity(), most = 0;
  const double gauss = 1 / std::sqrt(3.0);
  for (const double r : {-gauss, gauss})
    for (const double s : {-gauss, gauss}) {
      const Vec3 along_r = (1 - s) * (p[1] - p[0]) + (1 + s) * (p[2] - p[3]);
      const Vec3 along_s = (1 - r) * (p[3] - p[0]) + (1 + r) * (p[2] - p[1]);
      const double jacobian = dot(cross(along_r, along_s), normal);
      least = std::min(least, jacobian);
      most = std::max(most, jacobian);
    }
  return most > 0 ? least / most : 0;
}

/// Returns 90 degrees minus the angle between the lines through middles of opposite sides; 0 to 90.
inline double quad_skew(const std::array<Vec3, 4>& p) {
  const Vec3 a = p[1] + p[2] - p[0] - p[3], b = p[2] + p[3] - p[0] - p[1];
  return std::atan2(std::abs(dot(a, b)), norm(cross(a, b))) * 180 / std::numbers::pi;
}

/// Returns the largest share of half the quad's area, 0 to 1, that a triangle at a corner, cut off by a
/// diagonal, lacks.
inline double quad_taper(const std::array<Vec3, 4>& p) {
  const double half = norm(area_vector(p)) / 4;
  double least = half;
  for (size_t k = 0; k < 4; ++k)
    least = std::min(least, norm(cross(p[(k + 1) % 4] - p[k], p[(k + 3) % 4] - p[k])) / 2);
  return half > 0 ? 1 - least / half : 1;
}

/// Returns the characteristic length of a shell. LS-DYNA (theory manual, time step of shells) takes the area
/// over the longest side, twice that for triangles. Radioss (from OpenRadioss) takes the area over the longer
/// diagonal, at least the shortest side or diagonal; for triangles as LS-DYNA. Abaqus/Explicit (guide,
/// stability limit) takes the shortest distance across, here least_height().
template <size_t N>
double step_length(const std::array<Vec3, N>& p, StepLength by) {
  if (by == StepLength::kAbaqus) return least_height(p);
  const double area = norm(area_vector(p)) / 2;
  const auto [shortest, longest] = least_and_most_side(p);
  if constexpr (N == 3) {
    return 2 * area / longest;
  } else {
    if (by == StepLength::kLsDyna) return area / longest;
    const auto [less, more] = std::minmax({norm(p[2] - p[0]), norm(p[3] - p[1])});
    return std::max(area / more, std::min(shortest, less));
  }
}

/// Returns the value of an element of this shape: lengths and times in units of the model, angles in degrees.
/// `speed` is the speed of sound, above 0. Criteria for quads only give triangles the value of perfect quads.
template <size_t N>
double criterion_value(CriterionKind kind, const std::array<Vec3, N>& p, const ElementShape<N>& shape,
                       StepLength by, double speed) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  const auto of_quad = [&](auto&& value, double perfect) {
    if constexpr (N == 4)
      return value(p);
    else
      return perfect;
  };
  switch (kind) {
    case kMinLength:
      return least_and_most_side(p).first;
    case kMaxLength:
      return least_and_most_side(p).second;
    case kMinHeight:
      return least_height(p);
    case kMaxAspect: {
      const auto [least, most] = least_and_most_side(p);
      return most / least;
    }
    case kMinAngle:
      return std::ranges::min(shape.angle) * kDegrees;
    case kMaxAngle:
      return std::ranges::max(shape.angle) * kDegrees;
    case kMaxWarpage:
      return of_quad([](const auto& q) { return quad_warp(q) * 180 / std::numbers::pi; }, 0);
    case kMinJacobian:
      return N == 4 ? shape.scaled_jacobian : 1;
    case kMinGaussRatio:
      return of_quad(gauss_ratio, 1);
    case kMaxSkew:
      return of_quad(quad_skew, 0);
    case kMaxTaper:
      return of_quad(quad_taper, 0);
    case kMinTimeStep:
      return step_length(p, by) / speed;
    case kMinEta:
      break;
  }
  if constexpr (N == 4)
    return eta_of(shape.angle);
  else
    return 1;
}

}  // namespace delquad
