// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <tuple>
#include <vector>

#include "base/counters.h"
#include "delquad/extend.h"
#include "delquad/fields.h"
#include "delquad/mesh.h"
#include "delquad/options.h"

// This header has the insertion of points, stages F, D and P. Pipelines, layouts and cross fields use it.

namespace delquad {

/// Least height of a point over a boundary edge, in delta'.
inline constexpr double kBoundaryHeight = 0.5;

/// Options of insertion (F, D, P).
struct FrontalOptions {
  /// Largest size of resolved triangles over their ideal size, > 0; 0: default of the strategy.
  double h_max = 0;
  /// Least distance of a point from vertices, > 0, in delta' and the norm of the strategy.
  double rejection = 0.7;
  /// Limit of inserted points; the summary tells whether it stopped the mesher.
  long long max_points = 200'000'000;
};

OptionGroup insertion_group();
FrontalOptions insertion_options(const Options& options);

enum class FrontalTermination { kResolved, kMaxPoints };

struct FrontalSummary {
  FrontalTermination termination = FrontalTermination::kResolved;
  long long inserted = 0;    ///< points
  long long packed = 0;      ///< inserted by packing (P)
  long long rejected = 0;    ///< candidate points refused
  long long unresolved = 0;  ///< triangles above h_max because all their candidates were refused
  int layers = 0;
  double h_max = 0;  ///< value in use, of the option or of the strategy
  double seconds = 0;
};

inline const char* name_of(FrontalTermination termination) {
  return termination == FrontalTermination::kResolved ? "resolved" : "max_points";
}
inline void append_counter(std::vector<SummaryField>& fields, const char* key, FrontalTermination value,
                           Over over, double) {
  fields.push_back({key, name_of(value), over, static_cast<double>(value)});
}

template <>
struct Counters<FrontalSummary> {
  using S = FrontalSummary;
  static constexpr const char* step = "insertion";
  static constexpr auto all =
      std::tuple(counter("termination", &S::termination, Over::kMost), counter("inserted", &S::inserted),
                 counter("packed", &S::packed), counter("rejected", &S::rejected),
                 counter("unresolved", &S::unresolved), counter("layers", &S::layers, Over::kMost),
                 counter("h_max", &S::h_max, Over::kMost), counter("seconds", &S::seconds));
};

/// Returns the triangulation of a patch by frontal Delaunay insertion [remacle2013, section 5]: layer by
/// layer, largest active triangle first. `placement` chooses the points. They are connected by the
/// constrained Delaunay kernel of the L2 norm, as in the paper. Throws InputError for boundaries that
/// constrained_delaunay() refuses, and sizes that are not positive.
TriPatch mesh_frontal(const PatchBoundary& boundary, const PointPlacement& placement, const CrossField& cross,
                      const ParametricSize& size, const FrontalOptions& options = {},
                      FrontalSummary* summary = nullptr);

/// Does the same from a counterclockwise constrained Delaunay triangulation, which may have points inside.
TriPatch fill_frontal(const TriPatch& initial, const PointPlacement& placement, const CrossField& cross,
                      const ParametricSize& size, const FrontalOptions& options = {},
                      FrontalSummary* summary = nullptr);

/// Returns whether a boundary is oblique to the cross (own rule). Then grids by cross and size lie beside
/// more than half of its length, at more than 7 degrees to it.
bool is_misaligned(const PatchBoundary& boundary, const CrossField& cross, const ParametricSize& size);

/// Stage P: packs vertices along the cross, then fills the rest with the frontal mesher and `filler`.
///
/// A queue starts with the points of the boundary, or with the innermost point if is_misaligned(). Each
/// vertex proposes its four neighbors in a grid: one step of length delta' along each direction of the cross,
/// by the midpoint rule. A proposal is refused outside the domain and by the tests of mesh_frontal(). No
/// front or triangle matters, so legs and diagonals of half squares cannot be confused.
///
/// The method follows the packing of parallelograms [baudouin2014] in Gmsh (algorithm 9). Throws as
/// mesh_frontal().
TriPatch mesh_packing(const PatchBoundary& boundary, const PointPlacement& filler, const CrossField& cross,
                      const ParametricSize& size, const FrontalOptions& options = {},
                      FrontalSummary* summary = nullptr);

/// Stage D: mesh_frontal(), or mesh_packing() if is_misaligned(), since such a boundary would misguide the
/// front.
TriPatch mesh_delquad(const PatchBoundary& boundary, const PointPlacement& placement, const CrossField& cross,
                      const ParametricSize& size, const FrontalOptions& options = {},
                      FrontalSummary* summary = nullptr);

}  // namespace delquad
