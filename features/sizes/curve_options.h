// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "delquad/options.h"

// This header has the options of curves. Curves, the preparation and criteria use it.

namespace delquad {

/// How curves get their edges.
struct CurveOptions {
  /// Worth of an irregular vertex less, in quads times eta, see agree_on_counts(); 0: the size alone counts,
  /// and narrow faces are no grids.
  double agreement = 3;
  /// Small round holes get the edges of the square around them, see widen_round_holes().
  bool round_holes = false;
  /// Curves shorter than so many sizes become one with those that they continue, see join_short_curves().
  double join_below = 0.25;
  /// In the plane, regions thinner than the size get whole rows of quads. Else sizes become smaller where
  /// these regions end. On surfaces, numbers of edges agree first around narrow faces that can be grids, and
  /// narrow places keep one row.
  bool thin_rows = false;
  double aspect = 3;  ///< of quads in such rows, beyond which sizes become smaller
  /// Rows of quads for which sizes make room between curves that face each other, see gap_spots(); 0: none.
  int gap_rows = 0;
  /// Curves with a name stay, however small, see ignore_small().
  bool keep_named = false;
};

OptionGroup curve_group();
CurveOptions curve_options(const Options& options);

}  // namespace delquad
