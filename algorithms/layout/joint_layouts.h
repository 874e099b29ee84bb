// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <tuple>
#include <vector>

#include "algorithms/layout/layout.h"
#include "base/counters.h"
#include "delquad/fields.h"
#include "delquad/mesh.h"

// This header chooses edges on curves for all layouts together (stage R). The pipeline uses it on surfaces.

namespace delquad {

/// All edges of a curve, as a part of the boundary of a patch.
struct CurveRun {
  int curve, edges;
};

/// A patch whose quads a layout may replace.
struct LayoutPatch {
  QuadPatch mesh = {};
  PatchBoundary boundary = {};
  const CrossField* cross = nullptr;  ///< null: it takes no part, and its curves stay
  const ParametricSize* size = nullptr;
  std::vector<CurveRun> runs = {};  ///< runs of the boundary's edges, in order
  bool changed = false;             ///< whether the mesh was replaced
};

/// A curve with its number of edges and their least number; it may change if the curve is free.
struct LayoutCurve {
  int edges, least;
  bool is_free;
};

/// Patches that share curves.
struct LayoutNetwork {
  std::vector<LayoutPatch> patches;
  std::vector<LayoutCurve> curves;
  /// Returns the boundary of a patch for these numbers of edges on its curves; nothing if it encloses no
  /// quads.
  std::function<std::optional<PatchBoundary>(int patch, const std::vector<int>& edges)> boundary;
  /// Returns whether a patch may have this mesh.
  std::function<bool(const QuadPatch& mesh, const PatchBoundary& boundary)> is_allowed;
};

struct JointLayoutSummary {
  int chosen = 0;        ///< number of choices of edges
  long long filled = 0;  ///< meshes of patches made for these choices
  int accepted = 0;      ///< groups of patches whose new meshes were taken
  int patches = 0;       ///< changed patches
  int curves = 0;        ///< curves with a new number of edges
  int gained = 0;        ///< removed irregular vertices, counted in each patch
  double seconds = 0;
};

template <>
struct Counters<JointLayoutSummary> {
  using S = JointLayoutSummary;
  static constexpr const char* step = "layouts_together";
  static constexpr auto all = std::tuple(counter("chosen", &S::chosen), counter("filled", &S::filled),
                                         counter("accepted", &S::accepted), counter("patches", &S::patches),
                                         counter("curves", &S::curves), counter("gained", &S::gained),
                                         counter("seconds", &S::seconds));
};

/// Lays out all patches, with one choice of edges on all curves and lines (own method). Returns counts;
/// changed patches are marked.
///
/// Pieces of layouts are polygons of three to five sides. A grid closes if opposite sides have equal numbers
/// of edges, and a star if its arms find their feet. These conditions are sums of numbers of edges.
/// agree_counts() chooses the numbers at the least cost of changed sizes and open sums. (QuadWild with Bi-MDF
/// has one flow for patches that must all close [heistermann2023].) The pieces are then filled. A patch with
/// new numbers on its curves may also be meshed by D, B, C and Q if that is better.
///
/// Patches connected by such curves form a group. A group is taken if its loss for each removed irregular
/// vertex (PatchScore::loss()) is below the `price`, in quads times eta. An eta of 0.3 is enough for quads,
/// since O moves nodes along curves. Otherwise its most expensive patch keeps its curves, and numbers are
/// chosen again.
JointLayoutSummary lay_out_jointly(LayoutNetwork& network, double price);

}  // namespace delquad
