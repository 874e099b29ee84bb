// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "delquad/options.h"

// This header has the options of curves. Curves, the preparation and criteria use it.

namespace delquad {

/// Options of the edges on curves, the group "curves".
struct CurveOptions {
  /// Price of an irregular vertex, in quads times eta, 0 to 100, see agree_on_counts(). With 0 only the size
  /// counts, and narrow faces are no grids.
  double agreement = 3;
  /// Small round holes get the edges of the square around them, see widen_round_holes().
  bool round_holes = false;
  /// In the plane, regions thinner than the size get whole rows of quads; otherwise sizes shrink where these
  /// regions end. On surfaces, numbers of edges agree first around narrow faces that can be grids, and narrow
  /// places keep one row.
  bool thin_rows = false;
  double aspect = 3;  ///< of quads in such rows, 1 to 100, above which sizes shrink
  /// Rows of quads for which sizes make room between curves that face each other, 0 to 1000, see gap_spots();
  /// 0: none.
  int gap_rows = 0;
  /// Curves with a name stay, however small, see ignore_small().
  bool keep_named = false;
};

OptionGroup curve_group();
CurveOptions curve_options(const Options& options);

}  // namespace delquad
