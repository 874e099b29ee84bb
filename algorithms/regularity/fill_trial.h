// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "algorithms/regularity/cavity.h"
#include "algorithms/regularity/regularity.h"
#include "base/marks.h"
#include "geometry/mesh/quad_topology.h"
#include "smoothing/relocation/quad_relocation.h"

// This header tries fills of cavities. Stage Q uses it.

namespace delquad {

/// Limits of a round: loss for each removed irregular vertex, and quads of its cavities.
double tolerance_of(const RegularityOptions& options, int round);
double quads_per_gain_of(const RegularityOptions& options, int round);
/// Returns the rank of a cavity; lower ones are tried first. `left` counts irregular vertices of its pattern.
double promise_of(double quads, int left, int gain);
/// Limit of tried cavities of a vertex in a round; a third one brings nothing.
inline constexpr int kMostTrials = 2;

/// Sets the limits of relocation in stage Q. Relocates all active vertices at the end, and returns the moves.
void limit_relocation(QuadRelocation& relocation);
long long relax_at_last(QuadRelocation& relocation);

/// Moving vertices and quality of the elements around them when a cavity is filled.
class FillTrial {
 public:
  struct Quality {
    double mean = 0;  ///< mean of the elements' values
    double least_sine = 1;
    int failing = 0, thin = 0;
    double crowding = 0;
    int n = 0;
  };

  /// Both must outlive this object.
  FillTrial(const QuadTopology& mesh, QuadRelocation& relocation) : mesh_(mesh), relocation_(relocation) {}

  /// Collects vertices of the rim and of quads around it; vertices inside differ before and after.
  void collect_region(const Cavity& cavity);
  void collect_elements();
  void measure_before();
  Quality quality() const;
  void sweep();

  std::vector<int> region;  ///< moving vertices
  Quality before;

 private:
  const QuadTopology& mesh_;
  QuadRelocation& relocation_;
  std::vector<int> elements_;  ///< elements around the region
  Marks elements_met_, vertices_met_;
};

/// Relocates a filled cavity. Returns whether the loss of the mean falls to `allowed`, without more failing
/// quads. `tried` grows unless that holds from the start.
bool settle(FillTrial& trial, double allowed, double& loss, long long& tried);

}  // namespace delquad
