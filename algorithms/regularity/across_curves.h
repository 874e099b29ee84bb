#pragma once

#include <array>
#include <functional>
#include <tuple>
#include <vector>

#include "algorithms/regularity/regularity.h"
#include "base/counters.h"
#include "delquad/fields.h"
#include "delquad/mesh.h"

namespace delquad {

/// An edge of a patch's boundary: between the nodes `index` and index + 1 of a curve; `forward`: in its
/// order.
struct CurveEdge {
  int curve = -1, index = 0;
  bool forward = true;
};

/// A patch that ends at curves.
struct PatchAtCurves {
  QuadPatch mesh;
  const ParametricSize* size = nullptr;  ///< null: it takes no part
  std::vector<CurveEdge> edges;          ///< from each boundary point to the next of its loop
  bool changed = false;
};

/// Patches that share curves.
struct CurveNetwork {
  std::vector<PatchAtCurves> patches;
  std::vector<std::vector<double>> nodes;  ///< of each curve, the places of its nodes, ascending
  /// Of each curve the patches on its two sides, different ones; negative: its nodes stay.
  std::vector<std::array<int, 2>> sides;
  std::function<Vec2(int patch, int curve, double place)> at;  ///< of a curve in the patch's plane
};

struct AcrossCurvesSummary {
  long long tried = 0;  ///< cavities that were filled and relocated
  int accepted = 0;     ///< of these
  int longest = 0;      ///< patches of one that was accepted, at most
  int gained = 0;       ///< irregular vertices less, those of each patch counted
  int patches = 0;      ///< changed
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

/// make_regular() over curves that are kept.
///
/// A cavity that a curve cuts is a polygon on each side, and both have a stretch of the curve in common. The
/// number of edges of the stretch may grow or fall by two or four: where all polygons then have patterns with
/// fewer irregular vertices in all, those of a curve counted on either side, they are filled, each in the
/// plane of its patch, relocated together, and kept by what make_regular() asks for. A polygon may hand the
/// change on to another stretch, and so across narrow patches, kMostParts in all. Nodes of the stretch get
/// new places between the old ones; its ends stay, as all other nodes of curves do.
AcrossCurvesSummary make_regular_across_curves(CurveNetwork& network, const RegularityOptions& options);

}  // namespace delquad
