// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <tuple>

#include "base/counters.h"
#include "delquad/fields.h"
#include "delquad/mesh.h"

// This header has stages C and Q, which fill cavities with patterns. Pipelines and layouts use it.

namespace delquad {

struct RegularityOptions {
  double tolerance = 3;  ///< loss >= 0 for each removed irregular vertex in the last round; 0 in the first
  int quads = 200;       ///< most quads of a cavity
  int rounds = 3;        ///< rounds in which the tolerance grows
  double weight = 1;     ///< factor for the tolerances of all stages
  int usual_quads = 0;   ///< beyond them prices grow with the number of quads; 0: they do not
  /// Whether all vertices are relocated before, so that tangles of the matching are gone.
  bool settles_first = false;
};
/// Returns the options of stage C: nothing is paid, and vertices are relocated first.
RegularityOptions without_price(RegularityOptions options);

OptionGroup regularity_group();
/// Returns the options, with the tolerance multiplied by the weight.
RegularityOptions regularity_options(const Options& options);
/// Largest factor of a price.
inline constexpr double kMostPriceFactor = 4;
/// Returns the factor of all prices in a mesh of so many quads. A finer mesh then ends no more rows.
double price_factor(const RegularityOptions& options, double quads);

struct RegularitySummary {
  int irregular_before = 0;  ///< vertices whose valence is not ideal
  int irregular_after = 0;
  long long cavities = 0;   ///< cavities with patterns of fewer irregular vertices
  long long tried = 0;      ///< filled and relocated ones
  int accepted = 0;         ///< accepted ones
  int grids = 0;            ///< accepted ones without irregular vertices
  long long relocated = 0;  ///< moves of vertices at the end
  long long looks = 0;      ///< QuadRelocation::looks()
  double seconds = 0;
};

template <>
struct Counters<RegularitySummary> {
  using S = RegularitySummary;
  static constexpr const char* step = "regularity";
  static constexpr auto all = std::tuple(
      counter("irregular_before", &S::irregular_before), counter("irregular_after", &S::irregular_after),
      counter("cavities", &S::cavities), counter("tried", &S::tried), counter("accepted", &S::accepted),
      counter("grids", &S::grids), counter("relocated", &S::relocated), counter("looks", &S::looks),
      counter("seconds", &S::seconds));
};

/// Counts the vertices whose valence is not ideal, see ValenceEnergy.
int count_irregular(const QuadPatch& mesh);

/// The least eta around a fill or relocation never falls below both this and its old value.
inline constexpr double kFloorEta = 0.5;

/// Removes irregular vertices, for which it pays the tolerance. Stage C is stage Q
/// without a price. The idea of cavities is from [reberol2021], their growth and patterns are own.
///
/// Cavities grow around every irregular vertex, and from there to the nearest others. They add quads at
/// concave places of the rim until each rim vertex wants one quad inside (a corner) or two. The rim is then a
/// polygon whose sides have known numbers of edges, for which Pattern has meshes. Cavities whose pattern has
/// fewer irregular vertices are tried, those with the fewest quads for each removed one first. A fill is
/// relocated with a ring of quads around it. It is kept if the sum of eta - 1.5 * (size deviation) falls by
/// at most the tolerance for each removed irregular vertex. The sum is over as many quads as before. The
/// tolerance and the size of cavities grow from round to round, so cheap gains come first. A failed fill is
/// tried again only if the tolerance exceeds its loss, or quads have changed.
///
/// The number of irregular vertices never grows, and the least eta never falls below both kFloorEta
/// and its old value. No kept fill makes more quads fail (ElementQuality), which the sum hardly shows. Edges
/// without length are opened first; a mesh without them and without a kept fill does not change. Boundary
/// points keep their places and order, and leftover triangles stay. The mesh stays conforming, oriented and
/// of the same topology. The same input gives the same mesh. Time is linear in the number of irregular
/// vertices. Throws std::invalid_argument if the input is not conforming.
QuadPatch make_regular(const QuadPatch& mesh, const ParametricSize& size,
                       const RegularityOptions& options = {}, RegularitySummary* summary = nullptr);

}  // namespace delquad
