// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <tuple>

#include "base/counters.h"
#include "delquad/fields.h"
#include "delquad/mesh.h"

// This header adapts triangulations to size and cross by local edits. The pipeline uses it.

namespace delquad {

struct AdaptationOptions {
  int max_sweeps = 20;                 ///< limit of sweeps, >= 0; one with too few edits is the last
  long long max_points = 200'000'000;  ///< limit above which no edge is split
};

struct AdaptationSummary {
  int sweeps = 0;
  long long splits = 0, collapses = 0, swaps = 0;
  long long moves = 0;  ///< moves of vertices
  double seconds = 0;
};

template <>
struct Counters<AdaptationSummary> {
  using S = AdaptationSummary;
  static constexpr const char* step = "adaptation";
  static constexpr auto all =
      std::tuple(counter("sweeps", &S::sweeps, Over::kMost), counter("splits", &S::splits),
                 counter("collapses", &S::collapses), counter("swaps", &S::swaps),
                 counter("moves", &S::moves), counter("seconds", &S::seconds));
};

/// Adapts a triangulation to size and cross by local edits [tchon2006, as far as is known]. Its edges get the
/// length 1 in the L-infinity norm of the cross over delta', as legs and hypotenuses of half squares along
/// the cross. A sweep
/// - splits inner edges longer than sqrt 2 in the middle, longest first;
/// - collapses inner edges shorter than 1/sqrt 2, shortest first, unless an edge gets longer than sqrt 2;
/// - swaps inner edges if the worse of the two triangles improves by 2 A / l^2, with area A and longest edge
///   l in that norm. Half a square along the cross has 1;
/// - moves inner vertices to bring their edges nearest to legs or hypotenuses of half squares, in the mean
///   square. No triangle may get flat.
/// The source leaves open the measure, the order of edits, the end, and the goal of moves. Lengths in the
/// norm alone let rows slide: (1, a) and (0, 1) have length 1 for every a up to 1.
///
/// Boundary points and edges stay. The triangulation stays conforming and counterclockwise.
TriPatch adapt_linf(const TriPatch& tri, const CrossField& cross, const ParametricSize& size,
                    const AdaptationOptions& options = {}, AdaptationSummary* summary = nullptr);

}  // namespace delquad
