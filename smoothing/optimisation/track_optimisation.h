#pragma once

#include <array>
#include <tuple>
#include <vector>

#include "base/counters.h"
#include "delquad/fields.h"
#include "delquad/mesh.h"

namespace delquad {

struct OptimisationOptions {
  int passes = 4;            ///< at most; delta and the cross are evaluated anew before each
  int iterations = 30;       ///< of L-BFGS, at most: of the worst quads, then of the others, in each pass
  double size = 0.4;         ///< weight of the edges' lengths, see QuadEnergyWeights
  double alignment = 0.02;   ///< weight of the edges' directions
  double orthogonality = 0;  ///< weight of quads whose corners lie on no circle
};

OptionGroup optimisation_group();
OptimisationOptions optimisation_options(const Options& options);

struct OptimisationSummary {
  int untangled = 0;   ///< inverted or flat quads of the input that are so no more
  int held = 0;        ///< vertices kept in place that could move, but for flat quads
  int iterations = 0;  ///< of L-BFGS, those for the worst quads included
  int evaluations = 0;
  double energy_before = 0, energy_after = 0;  ///< of the pass over all quads
  double worst_before = 1, worst_after = 1;    ///< least eta of quads that can move, after untangling
  double seconds = 0;
};

template <>
struct Counters<OptimisationSummary> {
  using S = OptimisationSummary;
  static constexpr const char* step = "optimisation";
  static constexpr auto all = std::tuple(
      counter("untangled", &S::untangled), counter("held", &S::held), counter("iterations", &S::iterations),
      counter("evaluations", &S::evaluations), counter("energy_before", &S::energy_before),
      counter("energy_after", &S::energy_after), counter("worst_before", &S::worst_before, Over::kLeast),
      counter("worst_after", &S::worst_after, Over::kLeast), counter("seconds", &S::seconds));
};

/// The least eta never falls below both this and what it was.
inline constexpr double kOptimisedFloorEta = 0.6;

/// Where the last size and the last cross were found. It never changes what is found: start with a new one
/// and carry it along between nearby places.
struct TrackHint {
  int size = -1;
  int patch = -1, cross = -1;  ///< `cross` is of that patch

  /// That of a patch's cross.
  int& cross_of(int p) {
    if (patch != p) patch = p, cross = -1;
    return cross;
  }
};

/// Where the vertices of a quad mesh can go, in the plane (Vec2) or in space (Vec3): over surfaces, or along
/// curves. position(), put() and axes() of different vertices may be called from several threads at a time,
/// and so may delta() and arm() while the vertices around do not move.
template <class Vec>
class VertexTracks {
 public:
  virtual ~VertexTracks() = default;
  /// Parameters on the surface, or one along the curve and 0.
  virtual Vec2 position(int v) const = 0;
  /// Puts v at a position and returns its place. A curve ends where it ends.
  virtual Vec put(int v, Vec2 position) = 0;
  /// Derivatives of the place by the position, where v is; zero: it does not move that way.
  virtual std::array<Vec, 2> axes(int v) const = 0;
  /// The wanted edge length.
  virtual double delta(const Vec& place, TrackHint& hint) const = 0;
  /// Unit vector along one arm of the cross on a quad's side (by its first corner); zero: none.
  virtual Vec arm(int quad, int side, TrackHint& hint) const = 0;
};

/// Moves the vertices of a quad mesh together to the least of QuadEnergy by L-BFGS (Ceres). In each pass
/// those around the worst quads move first by themselves, with a weight on bad quads that lifts these; then
/// all, from the second pass on those around quads that are not good yet. `points` are the places of the
/// vertices on their tracks, and are updated. Works on several threads: a large mesh block by block, see
/// ElementBlocks, each with passes of its own.
///
/// Vertices of flat or inverted quads stay. In each pass vertices move along their tangents and are then put
/// on their tracks. No quad's least sine falls below both that of eta kOptimisedFloorEta and half a percent
/// less than it was before the pass, none below both that floor and the least of the whole mesh, none is
/// beyond what engineers ask for, see is_beyond_asked(), that was not before the pass, and no edge becomes
/// shorter than a fifth of what it was, or of delta where that is less: where that would be, the quad's
/// vertices go only part of the way, or stay. The same input gives the same mesh.
template <class Vec>
OptimisationSummary optimise_on_tracks(std::vector<Vec>& points, const std::vector<std::array<int, 4>>& quads,
                                       VertexTracks<Vec>& tracks, const OptimisationOptions& options = {});

/// Opens edges without length and untangles what is inverted or flat, with its surroundings. Connectivity and
/// boundary points stay. Returns how many quads are no more so. Throws std::invalid_argument where there
/// are such and the input is not conforming.
int untangle_flat(QuadPatch& mesh, const ParametricSize& size);

}  // namespace delquad
