#pragma once

#include <functional>
#include <optional>
#include <tuple>
#include <vector>

#include "algorithms/layout/layout.h"
#include "base/counters.h"
#include "delquad/fields.h"
#include "delquad/mesh.h"

namespace delquad {

/// All edges of a curve, where a patch's boundary runs along it.
struct CurveRun {
  int curve, edges;
};

/// A patch whose quads a layout may replace.
struct LayoutPatch {
  QuadPatch mesh = {};
  PatchBoundary boundary = {};
  const CrossField* cross = nullptr;  ///< null: it takes no part, and its curves stay
  const ParametricSize* size = nullptr;
  std::vector<CurveRun> runs = {};  ///< of the boundary's edges, in their order
  bool changed = false;
};

/// A curve whose number of edges may change.
struct LayoutCurve {
  int edges, least;
  bool is_free;
};

/// Patches that share curves.
struct LayoutNetwork {
  std::vector<LayoutPatch> patches;
  std::vector<LayoutCurve> curves;
  /// A patch's boundary where its curves have so many edges; none: it encloses no quads.
  std::function<std::optional<PatchBoundary>(int patch, const std::vector<int>& edges)> boundary;
  /// Whether a patch may have this mesh.
  std::function<bool(const QuadPatch& mesh, const PatchBoundary& boundary)> may_be;
};

struct TogetherSummary {
  int chosen = 0;        ///< times that numbers of edges were chosen
  long long filled = 0;  ///< meshes of patches that were made for these
  int accepted = 0;      ///< groups of patches that were taken
  int patches = 0;       ///< changed
  int curves = 0;        ///< with other numbers of edges
  int gained = 0;        ///< irregular vertices less, those of each patch counted
  double seconds = 0;
};

template <>
struct Counters<TogetherSummary> {
  using S = TogetherSummary;
  static constexpr const char* step = "layouts_together";
  static constexpr auto all = std::tuple(counter("chosen", &S::chosen), counter("filled", &S::filled),
                                         counter("accepted", &S::accepted), counter("patches", &S::patches),
                                         counter("curves", &S::curves), counter("gained", &S::gained),
                                         counter("seconds", &S::seconds));
};

/// Lays all patches out, and chooses the numbers of edges of all curves and lines for all layouts at once.
///
/// Pieces of layouts are polygons of three to five sides. A grid closes where opposite sides have as many
/// edges, a star where its arms find their feet: sums of numbers of edges, which agree_counts() chooses at
/// the least cost of the sizes that change and of the sums that stay open. (QuadWild with Bi-MDF has one flow
/// for patches that all have to close [heistermann2023].) The pieces get these numbers and are filled. A
/// patch whose curves have other numbers may also have a mesh of D, B, C and Q, where that is better.
///
/// Patches that hang together by such curves are a group. It is taken where it loses less than the tolerance
/// for each irregular vertex less, by what R asks for (see more_regular()), but with quads down to an eta of
/// .3, since O moves nodes along curves. Where it is not, its patch that costs most keeps its curves, and
/// numbers are chosen again. First an open sum costs what the tolerance says, then more: what loses less than
/// it seemed to is found so.
TogetherSummary lay_out_together(LayoutNetwork& network, const LayoutOptions& options);

}  // namespace delquad
