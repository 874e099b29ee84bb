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
  /// By which numbers of edges around grids are chosen; null: as all others. Sizes that follow the edges of
  /// grids must not make more of these.
  std::shared_ptr<const SizeField> grid_size = nullptr;
  CurveAgreement agreement = {};
};

/// Meshes the model's curves at equal integrals of ds/delta, and tells what they bound, regions named as in
/// the model. Each compulsory piece gets n = round(integral) edges, at least one (a closed curve three). Then
/// every region gets an even number of edges around it: pieces change by one, where |log((n +- 1)/integral)|
/// is least. If `agreement` asks for it, numbers agree, and nodes face each other across narrow places,
/// unless curves could then not be kept apart. Nodes that curves share come first, each once, in the order of
/// the curves. The curves of a loop may run either way and stand in any order. Ends that are equal up to
/// kJoinTolerance (see model_chain.h) are one node. Throws InputError for open
/// loops, zero-length curves, sizes not > 0, as build_domain(), and for loops whose curves touch although
/// their edges do not (see loops_apart.h).
PlanarDomain make_domain(const PlanarModel& model, const SizeField& size,
                         const CurveMeshOptions& options = {});

/// Returns the domain of chords of the model's curves, see divide_by_chords(). Chords become finer where they
/// would cross. Throws InputError as make_domain(), but numbers of edges are not even.
PlanarDomain chord_domain(const PlanarModel& model, const SizeField& size);

}  // namespace delquad
