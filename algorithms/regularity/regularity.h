#pragma once

#include <tuple>

#include "base/counters.h"
#include "delquad/fields.h"
#include "delquad/mesh.h"

namespace delquad {

struct RegularityOptions {
  double tolerance = 3;       ///< what an irregular vertex less may cost in the last round; none in the first
  int quads = 200;            ///< of a cavity, at most
  int rounds = 3;             ///< over which the tolerance grows
  double weight = 1;          ///< times what an irregular vertex less may cost by the options of any room
  bool across_curves = true;  ///< of surfaces: see make_regular_across_curves()
  double joined = 4;          ///< times the tolerance of surfaces with compounds
};

OptionGroup regularity_group();
/// With the tolerance times the weight.
RegularityOptions regularity_options(const Options& options);

struct RegularitySummary {
  int irregular_before = 0;  ///< vertices whose valence is not ideal
  int irregular_after = 0;
  long long cavities = 0;   ///< with patterns of fewer irregular vertices
  long long tried = 0;      ///< of these, filled and relocated
  int accepted = 0;         ///< of these
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

/// Lowers the number of irregular vertices of a quad mesh further than clean_up() can, which leaves pairs of
/// valences 3 and 5 that no edit of a few quads removes.
///
/// Around every irregular vertex, and from there to the nearest others, cavities are grown: their quads, with
/// more at concave places of the rim, until each vertex of the rim wants one quad inside (a corner) or two to
/// have its ideal valence. The rim is then a polygon with sides of so many edges, for which Pattern has
/// meshes with the fewest irregular vertices. Those that have fewer than the cavity are tried: the few with
/// the least quads for each irregular vertex less. A fill is relocated together with a ring of quads around,
/// and kept when the sum of eta - 1.5 * (size deviation) over the quads there (as many as before) loses no
/// more than the tolerance for each irregular vertex less. The tolerance grows from round to round, so that
/// what costs nothing comes first; so do the quads that a cavity may have for each irregular vertex less.
/// What has failed is not tried again before the tolerance is above what it lost, or other quads are there.
///
/// The number of irregular vertices never grows, and the least eta of the mesh never falls below both
/// kCleanupFloorEta and what it was. No fill is kept that makes more quads fail, see
/// ElementQuality: the sum hardly feels a single one. A mesh in which no fill is kept stays as it is.
/// Boundary points stay where they are, in their order, and leftover triangles stay; the mesh stays
/// conforming, oriented and of the same topology type. The same input gives the same mesh. Time is linear in
/// the number of irregular vertices. Throws std::invalid_argument where the input is not conforming.
QuadPatch make_regular(const QuadPatch& mesh, const ParametricSize& size,
                       const RegularityOptions& options = {}, RegularitySummary* summary = nullptr);

}  // namespace delquad
