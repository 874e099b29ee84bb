#pragma once

#include <cstddef>
#include <optional>
#include <tuple>

#include "algorithms/layout/patch_layout.h"
#include "base/counters.h"
#include "delquad/fields.h"
#include "delquad/mesh.h"
#include "smoothing/relocation/element_quality.h"

namespace delquad {

struct LayoutOptions {
  double tolerance = 4;  ///< what an irregular vertex less may cost where quads are there already
  int pieces = 2000;     ///< that are looked at in a patch, at most
};

OptionGroup layout_group();
LayoutOptions layout_options(const Options& options);

struct LayoutSummary {
  int patches = 0;      ///< that were to be laid out
  int without = 0;      ///< of these, for which there was no layout
  int worse = 0;        ///< of these, whose layout was not taken, as their quads are better
  int cuts = 0;         ///< rows of edges by which patches were cut
  int pieces = 0;       ///< polygons that were filled with patterns
  int mixed = 0;        ///< polygons without a pattern, which D, B and Q fill
  int irregular = 0;    ///< vertices of all
  long long looks = 0;  ///< pieces that were looked at
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

/// Quads of a patch by a layout: it is cut along lines of the cross field, from hole to hole first, then from
/// concave corners and where else it has to be, until each piece is a polygon of two to five corners that a
/// Pattern fills. A cut ends at vertices of the boundary or of other cuts, and has the number of edges that
/// its length asks for, one more or less where the piece's rim is odd. Of several cuts those are followed
/// that leave the fewest irregular vertices and the best quads. Pieces that no pattern fills, or none that is
/// worth its distortion, are meshed by themselves, with D, B and Q. All is relocated at last.
///
/// Boundary points stay where they are, in their order. None where no layout was found without flat or
/// inverted quads. The same input gives the same mesh.
std::optional<QuadPatch> lay_out(const PatchBoundary& boundary, const CrossField& cross,
                                 const ParametricSize& size, const LayoutOptions& options = {},
                                 LayoutSummary* summary = nullptr);

/// Whether lines and the boundary keep their edges when pieces are chosen, or get what pieces need later.
enum class LayoutEdges { kCounted, kFree };

/// The pieces of a layout, see lay_out(); none: not found. Where edges are free, a piece costs what its sizes
/// lose once its opposite sides (or a star's arms) have as many, and has three to five corners, but where no
/// line cuts it.
std::optional<PatchLayout> find_layout(const PatchBoundary& boundary, const CrossField& cross,
                                       const ParametricSize& size, LayoutEdges edges,
                                       const LayoutOptions& options, LayoutSummary& summary);
/// Its quads; none: some are flat or inverted.
std::optional<QuadPatch> fill_layout(const PatchLayout& layout, const PatchBoundary& boundary,
                                     const CrossField& cross, const ParametricSize& size,
                                     const LayoutOptions& options, LayoutSummary& summary);

/// What a mesh of a patch is worth beside another one.
struct PatchWorth {
  ElementQuality quality;
  int irregular = 0;
  std::size_t quads = 0;

  static PatchWorth of(const QuadPatch& mesh, const ParametricSize& size);
  /// The sum of eta - 1.5 * (size deviation) that goes with `now`, for as many quads; one more that fails
  /// (see ElementQuality) counts, too.
  double loss(const PatchWorth& now) const;
  /// Whether no quad of `now` is worse than both this eta and the worst there was, nor sides are more
  /// crowded.
  bool keeps_worst(const PatchWorth& now, double eta) const;
};

/// A layout that has fewer irregular vertices than a mesh of the patch, and loses less of the sum of
/// eta - 1.5 * (size deviation) than the tolerance for each; a quad more that fails (see ElementQuality) is a
/// loss, too. No quad of it is worse than both kCleanupFloorEta and those before. It looks at few pieces.
/// None: there is no such layout, or nothing to win.
std::optional<QuadPatch> more_regular(const QuadPatch& mesh, const PatchBoundary& boundary,
                                      const CrossField& cross, const ParametricSize& size,
                                      const LayoutOptions& options = {}, LayoutSummary* summary = nullptr);

}  // namespace delquad
