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

// This header divides patches into layouts of few pieces (stage R). The pipeline uses it.

namespace delquad {

struct LayoutSummary {
  int patches = 0;    ///< patches to lay out
  int without = 0;    ///< patches without a layout
  int worse = 0;      ///< patches whose own quads were better
  int irregular = 0;  ///< irregular vertices in all
  double seconds = 0;
};

template <>
struct Counters<LayoutSummary> {
  using S = LayoutSummary;
  static constexpr const char* step = "layout";
  static constexpr auto all = std::tuple(counter("patches", &S::patches), counter("without", &S::without),
                                         counter("worse", &S::worse), counter("irregular", &S::irregular),
                                         counter("seconds", &S::seconds));
};

/// Whether the choice of pieces keeps the edges of lines and boundary, or pieces set them later.
enum class LayoutEdges { kCounted, kFree };

/// Finds the pieces of a layout. Cuts follow lines of the cross field: first between holes, then from concave
/// corners, then where needed. A cut ends at vertices of the boundary or other cuts. Each piece becomes a
/// polygon of two to five corners that a Pattern fills. The chosen cuts leave the fewest irregular vertices
/// and the best quads. With free edges, a piece costs the loss of size after its opposite sides (or the arms
/// of a star) match. Such a piece has three to five corners unless a line cannot cut it. Counted ones examine
/// few pieces. Returns nothing if there is no layout.
std::optional<PatchLayout> find_layout(const PatchBoundary& boundary, const CrossField& cross,
                                       const ParametricSize& size, LayoutEdges edges);
/// Returns the quads of a layout after relocation; nothing if some are flat or inverted. Pieces without a
/// worthwhile pattern are meshed by D, B and Q. Boundary points keep their places and order.
std::optional<QuadPatch> fill_layout(const PatchLayout& layout, const PatchBoundary& boundary,
                                     const CrossField& cross, const ParametricSize& size);

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
/// (PatchScore::loss()) stays below the tolerance. No quad is worse than both kFloorEta and the old
/// worst. It examines few pieces. Returns nothing without such a layout.
std::optional<QuadPatch> more_regular(const QuadPatch& mesh, const PatchBoundary& boundary,
                                      const CrossField& cross, const ParametricSize& size, double price,
                                      LayoutSummary* summary = nullptr);

}  // namespace delquad
