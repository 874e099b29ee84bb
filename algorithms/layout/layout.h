// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <tuple>

#include "algorithms/layout/patch_layout.h"
#include "base/counters.h"
#include "delquad/fields.h"
#include "delquad/mesh.h"
#include "smoothing/relocation/element_quality.h"

// This header divides patches into layouts of few pieces (stages K and R). The pipeline uses it.

namespace delquad {

struct LayoutOptions {
  double tolerance = 4;  ///< allowed loss, >= 0, in quads times eta, for each removed irregular vertex
  int pieces = 2000;     ///< limit of examined pieces of a patch
};

OptionGroup layout_group();
LayoutOptions layout_options(const Options& options);

struct LayoutSummary {
  int patches = 0;      ///< patches to lay out
  int without = 0;      ///< patches without a layout
  int worse = 0;        ///< patches whose own quads were better
  int cuts = 0;         ///< rows of edges that cut patches
  int pieces = 0;       ///< polygons filled with patterns
  int mixed = 0;        ///< polygons without a pattern, filled by D, B and Q
  int irregular = 0;    ///< irregular vertices in all
  long long looks = 0;  ///< examined pieces
  double seconds = 0;
};

template <>
struct Counters<LayoutSummary> {
  using S = LayoutSummary;
  static constexpr const char* step = "layout";
  static constexpr auto all = std::tuple(
      counter("patches", &S::patches), counter("without", &S::without), counter("worse", &S::worse),
      counter("cuts", &S::cuts), counter("pieces", &S::pieces), counter("mixed", &S::mixed),
      counter("irregular", &S::irregular), counter("looks", &S::looks), counter("seconds", &S::seconds));
};

/// Meshes a patch by a layout (own method; Pattern as in [reberol2021]). Cuts follow lines of the cross
/// field: first between holes, then from concave corners, then where needed. Each piece becomes a polygon of
/// two to five corners that a Pattern fills. A cut ends at vertices of the boundary or other cuts. Its length
/// sets its number of edges, plus or minus one if a rim is odd. The chosen cuts leave the fewest irregular
/// vertices and the best quads. Pieces without a worthwhile pattern are meshed by D, B and Q. Relocation
/// comes last.
///
/// Boundary points keep their places and order. Returns nothing if no layout without flat or inverted quads
/// was found. The same input gives the same mesh.
std::optional<QuadPatch> lay_out(const PatchBoundary& boundary, const CrossField& cross,
                                 const ParametricSize& size, const LayoutOptions& options = {},
                                 LayoutSummary* summary = nullptr);

/// Choice of pieces: by the edges of lines and boundary, or with edges that are chosen later.
enum class LayoutEdges { kCounted, kFree };

/// Finds the pieces of a layout, see lay_out(). Returns nothing if there is none. With free edges, a piece
/// costs the loss of size after its opposite sides (or the arms of a star) match. Such a piece has three to
/// five corners unless a line cannot cut it.
std::optional<PatchLayout> find_layout(const PatchBoundary& boundary, const CrossField& cross,
                                       const ParametricSize& size, LayoutEdges edges,
                                       const LayoutOptions& options, LayoutSummary& summary);
/// Returns the quads of a layout; nothing if some are flat or inverted, or pieces do not fit together.
std::optional<QuadPatch> fill_layout(const PatchLayout& layout, const PatchBoundary& boundary,
                                     const CrossField& cross, const ParametricSize& size,
                                     const LayoutOptions& options, LayoutSummary& summary);

/// Value of a mesh of a patch, for comparison with another one.
struct PatchScore {
  ElementQuality quality;
  int irregular = 0;
  std::size_t quads = 0;

  static PatchScore of(const QuadPatch& mesh, const ParametricSize& size);
  /// Returns the loss from this to `now` of the sum of eta - 1.5 * (size deviation), scaled to the same
  /// number of quads. More failing quads (ElementQuality) add to it.
  double loss(const PatchScore& now) const;
  /// Returns whether `now` has no quad below both this eta, in [0, 1], and the old worst, and no more
  /// crowding.
  bool keeps_worst(const PatchScore& now, double eta) const;
};

/// Returns the quads of a layout with fewer irregular vertices than the mesh. For each of them its loss
/// (PatchScore::loss()) stays below the tolerance. No quad is worse than both kCleanupFloorEta and the old
/// worst. It examines few pieces. Returns nothing without such a layout.
std::optional<QuadPatch> more_regular(const QuadPatch& mesh, const PatchBoundary& boundary,
                                      const CrossField& cross, const ParametricSize& size,
                                      const LayoutOptions& options = {}, LayoutSummary* summary = nullptr);

}  // namespace delquad
