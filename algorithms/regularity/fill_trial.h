#pragma once

#include <span>
#include <vector>

#include "algorithms/regularity/cavity.h"
#include "algorithms/regularity/regularity.h"
#include "base/marks.h"
#include "geometry/mesh/quad_topology.h"
#include "smoothing/relocation/quad_relocation.h"

namespace delquad {

/// What a round allows: the loss for an irregular vertex less, and quads of its cavities.
double tolerance_of(const RegularityOptions& options, int round);
double quads_per_gain_of(const RegularityOptions& options, int round);
/// Cavities of which this is less are tried first. `left`: irregular vertices of its pattern.
double promise_of(double quads, int left, int gain);
/// Cavities of a vertex that are tried in a round. A third brings nothing.
inline constexpr int kMostTrials = 2;

/// Relocation as Q does it, and of all vertices that are active once it is done. Returns the moves.
void hold(QuadRelocation& relocation);
long long relax_at_last(QuadRelocation& relocation);

/// What moves when a cavity is filled, and what becomes of the elements there.
class FillTrial {
 public:
  struct Quality {
    double mean = 0;  ///< of the elements' values
    double least_sine = 1;
    int failing = 0, thin = 0;
    double crowding = 0;
    int n = 0;
  };

  /// Both outlive this object.
  FillTrial(const QuadTopology& mesh, QuadRelocation& relocation) : mesh_(mesh), relocation_(relocation) {}

  /// The vertices of the rim and of the quads around it; those within are others before and after.
  void collect_region(const Cavity& cavity);
  void collect_elements();
  void measure_before();
  Quality quality() const;
  void sweep();

  std::vector<int> region;  ///< vertices that move
  Quality before;

 private:
  const QuadTopology& mesh_;
  QuadRelocation& relocation_;
  std::vector<int> elements_;  ///< around the region
  Marks elements_met_, vertices_met_;
};

/// Relocates cavities that were filled together; whether the loss of their mean gets as small as allowed,
/// with at most so many quads more that fail. `tried` is counted up where it is not that from the start.
bool settle(std::span<FillTrial> trials, double allowed, int more_failing, double& loss, long long& tried);

}  // namespace delquad
