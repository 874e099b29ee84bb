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

/// Makes a curve of point(t) for t from t0 to t1, either direction, of a function that is called here and
/// never again. It is replaced by polynomials that miss it by kSampledCurveError of its extent at most,
/// except at kinks. Throws InputError for points that are not finite, naming t, and where it cannot be
/// followed.
std::shared_ptr<const Curve> make_sampled_curve(const CurveFunction& function, double t0, double t1);

inline constexpr double kSampledCurveError = 1e-10;

}  // namespace delquad
