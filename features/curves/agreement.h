// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// This header has the options by which numbers of edges agree. Curves and the preparation use it.

namespace delquad {

/// Largest number of steps of agree_counts() and align_opposite_nodes() together: about ten seconds.
constexpr long long kMostAgreementSteps = 200'000'000;

/// Settings of the agreement between numbers of edges.
struct CurveAgreement {
  double price = 0;  ///< of an irregular vertex, see agree_on_counts(); 0: numbers follow the size alone
  long long most_steps = kMostAgreementSteps;
  bool round_holes = false;   ///< see widen_round_holes()
  double shortest = 0;        ///< least length of edges on curves, in requested sizes, if possible
  bool thin_rows = false;     ///< see CurveOptions::thin_rows
  bool narrow_grids = false;  ///< narrow faces become grids, too, see GridFinder
};

}  // namespace delquad
