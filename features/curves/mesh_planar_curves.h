// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "delquad/fields.h"
#include "features/curves/agreement.h"
#include "geometry/planar/planar_model.h"

// This header divides the curves of planar models into edges. The preparation and metrics use it.

namespace delquad {

struct CurveMeshOptions {
  /// Largest number of boundary edges. Above it, InputError with the estimate is thrown before anything is
  /// allocated.
  double max_edges = 1e8;
  std::vector<CurveDivision> divisions = {};
  std::vector<PeriodicPair> periodic = {};
  MappedSpec mapped = {};
  bool narrow_grids = false;  ///< narrow faces become grids, too, see GridFinder
  SymmetrySpec symmetry = {};
  /// Size by which numbers of edges around grids are chosen; empty: the size of all others. Sizes that follow
  /// the edges of grids must not raise these numbers.
  PointSize grid_size = {};
  CurveAgreement agreement = {};
  /// The size for several threads; null: one thread calls the function.
  std::shared_ptr<const SizeField> size_field = nullptr;
};

/// Divides the curves of a model at equal integrals of ds/delta, and returns the regions that they bound,
/// with names as in the model. Each compulsory piece gets n = round(integral) edges, at least one (a closed
/// curve three). Then every region gets an even number of edges around it: pieces change by one at the least
/// |log((n +- 1)/integral)| [edmonds1973]. If `agreement` asks for it, numbers agree, and nodes face each
/// other across narrow places, unless curves could then not be kept apart.
///
/// Shared nodes come first, each once, in the order of the curves. The curves of a loop may have any
/// orientation and order. Ends that are equal up to kJoinTolerance (see model_chain.h) are one node. Throws
/// InputError, with the curve or place, for open loops, zero-length curves and sizes that are not above 0.
/// Also throws as build_domain(), and for loops whose curves touch although their edges do not (see
/// loops_apart.h).
PlanarDomain make_domain(const PlanarModel& model, const PointSize& size,
                         const CurveMeshOptions& options = {});

}  // namespace delquad
