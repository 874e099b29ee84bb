// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "delquad/model.h"

// This header makes curves of functions. The Python module uses it.

namespace delquad {

/// Writes the points of a batch of parameters.
using CurveFunction = std::function<void(std::span<const double> t, std::span<Vec2> points)>;

/// Returns a curve through the points of a function for t from t0 to t1, in either direction; the function is
/// called here only. Chebyshev polynomials (own subdivision) replace it with an error of kSampledCurveError
/// over its extent, except at kinks. Throws InputError, with t, for points that are not finite, and if 20 000
/// polynomials are not enough.
std::shared_ptr<const Curve> make_sampled_curve(const CurveFunction& function, double t0, double t1);

inline constexpr double kSampledCurveError = 1e-10;

}  // namespace delquad
