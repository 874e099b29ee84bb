// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <tuple>
#include <vector>

#include "base/counters.h"
#include "delquad/options.h"
#include "smoothing/cvt/cell_minimiser.h"

// This header has stage L, Lp-CVT smoothing. The pipeline uses it.

namespace delquad {

struct SmoothingOptions {
  /// Exponent of the norm: even, 2 to 16. At 6 or more a square lattice is a minimum of the energy, and not
  /// only stationary.
  int p = 6;
  int outer_iterations = 2;  ///< how often cross and size are taken again; at least 0
  MinimiserOptions inner;    ///< options of each
};

/// Throws InputError, with the name, if an option is out of its range.
void check_options(const SmoothingOptions& options);

enum class SmoothingTermination {
  kConverged,   ///< with the last frames
  kIterations,  ///< limit of iterations
  kStuck,       ///< no admissible step lowers the energy
  kRefused      ///< the energy at the start is not defined, so points stay
};

struct SmoothingSummary {
  SmoothingTermination termination = SmoothingTermination::kConverged;
  int cells = 0;  ///< number of points, boundary points included
  int outer_iterations = 0;
  int iterations = 0;        ///< accepted steps
  int evaluations = 0;       ///< number of evaluations, refused ones included
  int refused = 0;           ///< refused places that were not admissible
  long long flips = 0;       ///< flips of the triangulation
  int rebuilds = 0;          ///< rebuilds of the triangulation
  double first_energy = 0;   ///< 1: squares of the wanted size everywhere
  double final_energy = 0;   ///< in the last frames
  double gradient_norm = 0;  ///< see `MinimiserOutcome`
  double seconds = 0;
  std::vector<EnergySample> samples;  ///< all evaluations
};

const char* name_of(SmoothingTermination termination);
/// Counts patches by the way in which they ended.
void append_counter(std::vector<SummaryField>& fields, const char* key, SmoothingTermination value, Over,
                    double);
/// Appends lists for each patch. They are the energies (NaN if refused), the first evaluations with new
/// frames ("first_of_frames"), and accepted ones ("accepted_evaluations"). Evaluations count from 0.
void append_counter(std::vector<SummaryField>& fields, const char* key,
                    const std::vector<EnergySample>& samples, Over, double);

template <>
struct Counters<SmoothingSummary> {
  using S = SmoothingSummary;
  static constexpr const char* step = "smoothing";
  static double weight(const S& summary) { return summary.cells; }
  static constexpr auto all = std::tuple(
      counter("termination", &S::termination), counter("cells", &S::cells),
      counter("outer_iterations", &S::outer_iterations, Over::kMost), counter("iterations", &S::iterations),
      counter("evaluations", &S::evaluations), counter("refused", &S::refused), counter("flips", &S::flips),
      counter("rebuilds", &S::rebuilds), counter("first_energy", &S::first_energy, Over::kMean),
      counter("final_energy", &S::final_energy, Over::kMean),
      counter("gradient_norm", &S::gradient_norm, Over::kMost), counter("seconds", &S::seconds),
      counter("energy_by_evaluation", &S::samples));
};

/// Moves the inner points of a patch so that their Voronoi cells become squares of side delta' along the
/// cross [levy2010; baudouin2014]. The number of points limits this. Boundary points stay. Returns the
/// constrained Delaunay triangulation of the moved points, in their order. Throws InputError for options out
/// of range and flat or inverted triangles.
TriPatch smooth_points(const TriPatch& patch, const CrossField& cross, const ParametricSize& size,
                       const SmoothingOptions& options = {}, SmoothingSummary* summary = nullptr);

OptionGroup smoothing_group();
SmoothingOptions smoothing_options(const Options& options);

}  // namespace delquad
