// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// This header has the options by which numbers of edges agree. Curves and the preparation use it.

namespace delquad {

/// Steps of agree_counts(), and what align_opposite_nodes() takes of them: some ten seconds.
constexpr long long kMostAgreementSteps = 200'000'000;

/// How far numbers of edges agree.
struct CurveAgreement {
  double price = 0;  ///< of agree_on_counts(); 0: numbers follow the size alone
  long long most_steps = kMostAgreementSteps;
  bool round_holes = false;  ///< see widen_round_holes()
  double shortest = 0;       ///< edges on curves, in sizes as asked, are longer if possible
  bool thin_rows = false;    ///< see CurveOptions::thin_rows
};

}  // namespace delquad
