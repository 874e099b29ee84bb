// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>
#include <tuple>
#include <vector>

#include "algorithms/regularity/regularity.h"
#include "base/counters.h"
#include "delquad/fields.h"
#include "delquad/mesh.h"

// This header has stage Q across curves. The pipeline uses it on surfaces.

namespace delquad {

/// A boundary edge of a patch between the nodes `index` and index + 1 of a curve; `forward` if it runs in the
/// curve's order.
struct CurveEdge {
  int curve = -1, index = 0;
  bool forward = true;
};

/// Patch that ends at curves.
struct PatchAtCurves {
  QuadPatch mesh;
  const ParametricSize* size = nullptr;  ///< null: it takes no part
  std::vector<CurveEdge> edges;          ///< edge from each boundary point to the next of its loop
  bool changed = false;                  ///< whether the mesh was changed
};

/// Patches that share curves.
struct CurveNetwork {
  std::vector<PatchAtCurves> patches;
  std::vector<std::vector<double>> nodes;  ///< parameters of each curve's nodes, ascending
  /// The two distinct patches at each curve; negative: its nodes stay.
  std::vector<std::array<int, 2>> sides;
  std::function<Vec2(int patch, int curve, double place)> at;  ///< point of a curve in the plane of the patch
};

struct AcrossCurvesSummary {
  long long tried = 0;  ///< cavities that were filled and relocated
  int accepted = 0;     ///< accepted ones
  int longest = 0;      ///< most patches of an accepted one
  int gained = 0;       ///< removed irregular vertices, counted in each patch
  int patches = 0;      ///< changed patches
  double seconds = 0;
};

template <>
struct Counters<AcrossCurvesSummary> {
  using S = AcrossCurvesSummary;
  static constexpr const char* step = "across_curves";
  static constexpr auto all =
      std::tuple(counter("tried", &S::tried), counter("accepted", &S::accepted),
                 counter("longest", &S::longest, Over::kMost), counter("gained", &S::gained),
                 counter("patches", &S::patches), counter("seconds", &S::seconds));
};

/// Runs make_regular() across curves, which keep their shape (own method). Returns counts; changed patches
/// are marked.
///
/// A curve cuts a cavity into a polygon on each side, and both share a stretch of the curve. The stretch may
/// gain or lose two or four edges. If all polygons then have patterns with fewer irregular vertices in total
/// (vertices of a curve count on either side), they are filled. Each fill lies in the plane of its patch, all
/// are relocated together, and the tests of make_regular() apply. A polygon may pass the change on to another
/// stretch, across up to kMostParts patches. Nodes of the stretch move between the old ones; its ends and all
/// other nodes stay.
AcrossCurvesSummary make_regular_across_curves(CurveNetwork& network, const RegularityOptions& options);

}  // namespace delquad
