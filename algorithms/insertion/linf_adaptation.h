#pragma once

#include <tuple>

#include "base/counters.h"
#include "delquad/fields.h"
#include "delquad/mesh.h"

namespace delquad {

struct AdaptationOptions {
  int max_sweeps = 20;  ///< stops earlier when a sweep makes less than one edit in a thousand triangles
  long long max_points = 200'000'000;  ///< no edge is split beyond
};

struct AdaptationSummary {
  int sweeps = 0;
  long long splits = 0, collapses = 0, swaps = 0;
  long long moves = 0;  ///< of vertices
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

/// Adapts a triangulation to a size and a cross field by local edits, so that its edges have the length 1 in
/// the L-infinity norm of the cross over delta' [tchon2006, as far as is known]: legs and hypotenuses of half
/// squares along the cross alike. A sweep
/// - splits inner edges longer than sqrt 2 in their middle, the longest first;
/// - collapses inner edges shorter than 1/sqrt 2, the shortest first, where no edge gets longer than sqrt 2;
/// - swaps inner edges where the worse of the two triangles gets better, by 2 A / l^2 with A the area and l
/// the
///   longest edge, both in that norm: 1 for half a square along the cross;
/// - moves inner vertices to where their edges are nearest, in the mean of squares, to legs or hypotenuses of
///   half squares, as long as no triangle gets flat.
/// What had to be guessed: the measure, the order of the edits, when to stop, and what vertices move for.
/// Lengths in the norm alone, which were minimised there, leave rows free to slide: (1, a) and (0, 1) have
/// length 1 for every a up to 1.
///
/// Boundary points and edges stay; the triangulation stays conforming and counterclockwise.
TriPatch adapt_linf(const TriPatch& tri, const CrossField& cross, const ParametricSize& size,
                    const AdaptationOptions& options = {}, AdaptationSummary* summary = nullptr);

}  // namespace delquad
