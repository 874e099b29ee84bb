// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/calibration.h"

#include <algorithm>
#include <cmath>

namespace delquad {
namespace {

/// Largest factor of a scale, up or down; more would be another case.
constexpr double kLargestScale = 4;
/// Narrowest bracket, in log scale. A narrower one contains a jump of the number of quads, which otherwise
/// hardly changes in it.
constexpr double kNarrow = 2e-3;
/// A number of quads does not follow the size if its logarithm changes by less than kNoAnswer over kChange of
/// log scale.
constexpr double kNoAnswer = 1e-3, kChange = 0.02;
/// Limits and usual value of the power of size that numbers of quads follow; -2 in the plane without other
/// limits.
constexpr double kSteepest = -4, kFlattest = -0.5, kUsual = -2;

struct Try {
  double log_scale;
  double excess;  ///< log of the number over the wanted one
};

/// Returns the closest pair around the wanted number: a finer scale and a coarser one.
std::optional<std::pair<Try, Try>> bracket(const std::vector<Try>& tries) {
  std::optional<Try> fine, coarse;
  for (const Try& t : tries) {
    if (t.excess > 0 && (!fine || t.log_scale > fine->log_scale)) fine = t;
    if (t.excess < 0 && (!coarse || t.log_scale < coarse->log_scale)) coarse = t;
  }
  if (!fine || !coarse || !(fine->log_scale < coarse->log_scale)) return std::nullopt;
  return std::pair(*fine, *coarse);
}

std::optional<double> inside(const Try& fine, const Try& coarse) {
  constexpr double kLeast = 0.1;  // least part of the bracket from its ends, so that it shrinks
  const double width = coarse.log_scale - fine.log_scale;
  if (width < kNarrow) return std::nullopt;
  const double part = fine.excess / (fine.excess - coarse.excess);
  return fine.log_scale + width * std::clamp(part, kLeast, 1 - kLeast);
}

/// Returns the next log scale to try; nothing if none is useful.
std::optional<double> next_log_scale(const std::vector<Try>& tries) {
  if (const auto pair = bracket(tries)) return inside(pair->first, pair->second);
  const Try& last = tries.back();
  double power = kUsual;
  if (tries.size() > 1) {
    const Try& before = tries[tries.size() - 2];
    const double change = last.log_scale - before.log_scale, answer = last.excess - before.excess;
    if (std::abs(change) > kChange && std::abs(answer) < kNoAnswer) return std::nullopt;
    power = std::clamp(answer / change, kSteepest, kFlattest);
  }
  const double limit = std::log(kLargestScale);
  const double next = std::clamp(last.log_scale - last.excess / power, -limit, limit);
  return next == last.log_scale ? std::nullopt : std::optional(next);
}

}  // namespace

double count_of_quads(const Mesh& mesh) {
  return static_cast<double>(mesh.quads.size()) + 0.5 * static_cast<double>(mesh.triangles.size());
}

Calibration calibrate_scale(double wanted, const CalibrationLimits& limits,
                            const std::function<std::optional<double>(double scale)>& quads_at) {
  Calibration best;
  std::vector<Try> tries;
  std::optional<double> log_scale = 0;
  const auto off = [&](double quads) { return std::abs(std::log(quads / wanted)); };
  for (int runs = 1; log_scale && runs <= limits.most_runs; ++runs) {
    const double scale = std::exp(*log_scale);
    const std::optional<double> quads = quads_at(scale);
    if (!quads || !(*quads > 0)) {
      best.runs = runs;
      break;
    }
    if (tries.empty() || off(*quads) < off(best.quads)) {
      best.scale = scale;
      best.quads = *quads;
    }
    best.runs = runs;
    best.tried.push_back({scale, *quads});
    if (std::abs(*quads / wanted - 1) <= limits.tolerance) break;
    tries.push_back({*log_scale, std::log(*quads / wanted)});
    log_scale = next_log_scale(tries);
  }
  return best;
}

}  // namespace delquad
