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

/// Return the limits of a round, from 0: loss, and quads of cavities, for each removed irregular vertex.
double tolerance_of(const RegularityOptions& options, int round);
double quads_per_gain_of(const RegularityOptions& options, int round);
/// Returns the rank of a cavity of so many quads; lower ones are tried first. `left` counts irregular
/// vertices of its pattern, `gain` > 0 removed ones.
double promise_of(double quads, int left, int gain);
/// Limit of tried cavities of a vertex in a round; a third one brings nothing.
inline constexpr int kMostTrials = 2;

/// Sets the limits of relocation in stage Q.
void limit_relocation(QuadRelocation& relocation);
/// Relocates all active vertices at the end. Returns the number of moves.
long long relax_at_last(QuadRelocation& relocation);

/// Moving vertices and quality of the elements around them when a cavity is filled.
class FillTrial {
 public:
  struct Quality {
    double mean = 0;  ///< mean of the elements' values
    double least_sine = 1;
    int failing = 0, thin = 0;
    double crowding = 0;
    int n = 0;  ///< number of elements
  };

  /// Both must outlive this object.
  FillTrial(const QuadTopology& mesh, QuadRelocation& relocation) : mesh_(mesh), relocation_(relocation) {}

  /// Sets the region to vertices of the rim and of quads around it; vertices inside differ before and after.
  void collect_region(const Cavity& cavity);
  /// Collects the elements around the region, for quality().
  void collect_elements();
  void measure_before();
  /// Returns the quality of the collected elements.
  Quality quality() const;
  /// Relocates each vertex of the region once.
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
