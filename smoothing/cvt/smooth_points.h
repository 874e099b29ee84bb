#pragma once

#include <tuple>
#include <vector>

#include "base/counters.h"
#include "delquad/options.h"
#include "smoothing/cvt/cell_minimiser.h"

namespace delquad {

struct SmoothingOptions {
  /// Of the norm: even, 2 to 16. 6 is the smallest for which a square lattice is a minimum of the energy, and
  /// not only stationary.
  int p = 6;
  int outer_iterations = 2;  ///< how often cross and size are taken anew; at least 0
  MinimiserOptions inner;    ///< of each
};

/// Throws InputError that says which option is out of its range.
void check_options(const SmoothingOptions& options);

enum class SmoothingTermination {
  kConverged,   ///< with the frames taken last
  kIterations,  ///< all that were allowed
  kStuck,       ///< no admissible step that lowers the energy was found
  kRefused      ///< the energy of the points as they were cannot be told: they stay
};

struct SmoothingSummary {
  SmoothingTermination termination = SmoothingTermination::kConverged;
  int cells = 0;  ///< as many as points, the boundary's included
  int outer_iterations = 0;
  int iterations = 0;        ///< accepted steps
  int evaluations = 0;       ///< of the energy, refused ones included
  int refused = 0;           ///< of them, at places that are not admissible
  long long flips = 0;       ///< of the triangulation, following the points
  int rebuilds = 0;          ///< of the triangulation from nothing
  double first_energy = 0;   ///< 1: squares of the wanted size everywhere
  double final_energy = 0;   ///< in the frames taken last
  double gradient_norm = 0;  ///< see MinimiserOutcome
  double seconds = 0;
  std::vector<EnergySample> samples;  ///< all evaluations
};

const char* name_of(SmoothingTermination termination);
/// How often patches ended in which way.
void append_counter(std::vector<SummaryField>& fields, const char* key, SmoothingTermination value, Over,
                    double);
/// A list for each patch: the energies, NaN where the place was refused; the evaluations, counted from 0,
/// that were the first with new frames, as "first_of_frames"; and those from where the points went on, as
/// "accepted_evaluations".
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
/// cross field, as far as the number of points allows [section 7]. Boundary points stay. The result is the
/// constrained Delaunay triangulation of the moved points: the same points, in their order.
TriPatch smooth_points(const TriPatch& patch, const CrossField& cross, const ParametricSize& size,
                       const SmoothingOptions& options = {}, SmoothingSummary* summary = nullptr);

OptionGroup smoothing_group();
SmoothingOptions smoothing_options(const Options& options);

}  // namespace delquad
