#pragma once

#include <tuple>
#include <vector>

#include "base/counters.h"
#include "delquad/extend.h"
#include "delquad/fields.h"
#include "delquad/mesh.h"
#include "delquad/options.h"

namespace delquad {

/// Points whose height above a boundary edge is below this times delta' are refused.
inline constexpr double kBoundaryHeight = 0.5;

/// What insertion (F, D, P) can be told.
struct FrontalOptions {
  /// A triangle is resolved when its dimensionless size is at most h_max (1: ideal). 0: the strategy's own
  /// default.
  double h_max = 0;
  /// A point nearer than rejection * delta' to a vertex (in the strategy's norm) is refused.
  double rejection = 0.7;
  /// The most points to insert; the summary says when it stopped the mesher.
  long long max_points = 200'000'000;
};

OptionGroup insertion_group();
FrontalOptions insertion_options(const Options& options);

enum class FrontalTermination { kResolved, kMaxPoints };

struct FrontalSummary {
  FrontalTermination termination = FrontalTermination::kResolved;
  long long inserted = 0;    ///< points
  long long packed = 0;      ///< of these, by packing (P)
  long long rejected = 0;    ///< candidate points refused
  long long unresolved = 0;  ///< triangles left above h_max because every candidate was refused
  int layers = 0;
  double h_max = 0;  ///< that was used: the option's or the strategy's own
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

/// Frontal Delaunay mesher [paper, section 5]: layer by layer, largest active triangle first, one strategy
/// for where the point goes. Connects by the ordinary (L2) constrained Delaunay kernel, as the paper does.
TriPatch mesh_frontal(const PatchBoundary& boundary, const PointPlacement& placement, const CrossField& cross,
                      const ParametricSize& size, const FrontalOptions& options = {},
                      FrontalSummary* summary = nullptr);

/// The same, from a constrained Delaunay triangulation that may have points inside already.
TriPatch fill_frontal(const TriPatch& initial, const PointPlacement& placement, const CrossField& cross,
                      const ParametricSize& size, const FrontalOptions& options = {},
                      FrontalSummary* summary = nullptr);

/// Whether a boundary strays from the cross: beside more than half of its length there are grids, by cross
/// and size, whose rows do not run along it, nor into it at a right angle.
bool is_astray(const PatchBoundary& boundary, const CrossField& cross, const ParametricSize& size);

/// P: packs vertices along the cross, then fills what is left by the frontal mesher with `filler`.
///
/// First in, first out from the boundary's points (where the boundary is astray, from the point farthest from
/// it), each vertex proposes its four neighbours in a grid: one step of length delta' along each direction of
/// the cross, by the midpoint rule. A proposal is refused outside the domain and by the same tests as in
/// mesh_frontal(). A vertex knows of no front and no triangles, so that legs and diagonals of half squares
/// cannot be taken for each other.
///
/// After the packing of parallelograms in Gmsh (algorithm 9).
TriPatch mesh_packing(const PatchBoundary& boundary, const PointPlacement& filler, const CrossField& cross,
                      const ParametricSize& size, const FrontalOptions& options = {},
                      FrontalSummary* summary = nullptr);

/// D: mesh_frontal(), but mesh_packing() where the boundary is astray, which would lead the front astray.
TriPatch mesh_delquad(const PatchBoundary& boundary, const PointPlacement& placement, const CrossField& cross,
                      const ParametricSize& size, const FrontalOptions& options = {},
                      FrontalSummary* summary = nullptr);

}  // namespace delquad
