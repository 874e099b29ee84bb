// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <tuple>
#include <vector>

#include "base/counters.h"
#include "delquad/fields.h"
#include "delquad/mesh.h"

// This header has stage O, vertex optimization on tracks. The pipeline and layouts use it.

namespace delquad {

struct OptimisationOptions {
  int passes = 4;       ///< most passes; each evaluates delta and cross again
  int iterations = 30;  ///< most iterations of L-BFGS, for the worst quads and for the others, in each pass
  double size = 0.4;    ///< weight of lengths of edges, see QuadEnergyWeights
  double alignment = 0.02;   ///< weight of directions of edges
  double orthogonality = 0;  ///< weight of quads whose corners lie on no circle
  QuadLimits limits = {};    ///< of the result
};

OptionGroup optimisation_group();
OptimisationOptions optimisation_options(const Options& options);

struct OptimisationSummary {
  int untangled = 0;   ///< inverted or flat quads that were repaired
  int held = 0;        ///< movable vertices that stayed because of flat quads
  int iterations = 0;  ///< iterations of L-BFGS, with the worst quads
  int evaluations = 0;
  double energy_before = 0, energy_after = 0;  ///< of the passes over all quads
  double worst_before = 1, worst_after = 1;    ///< least eta of movable quads, after untangling
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

/// The least eta never falls below both this and its old value.
inline constexpr double kOptimisedFloorEta = 0.6;

/// Hints of the last size and cross. They never change a result: start with a new object and pass it on
/// between nearby places.
struct TrackHint {
  int size = -1;
  int patch = -1, cross = -1;  ///< `cross` is the hint of this patch

  /// Returns the hint of a patch's cross.
  int& cross_of(int p) {
    if (patch != p) patch = p, cross = -1;
    return cross;
  }
};

/// Tracks of the vertices of a quad mesh, in the plane (Vec2) or in space (Vec3): surfaces or curves. Threads
/// may call position(), put() and axes() of different vertices at once. They may call delta() and arm() while
/// vertices around do not move.
template <class Vec>
class VertexTracks {
 public:
  virtual ~VertexTracks() = default;
  /// Returns the parameters in the patch's plane, or the parameter on the curve and 0.
  virtual Vec2 position(int v) const = 0;
  /// Puts v at a position, within the range of a curve, and returns its place.
  virtual Vec put(int v, Vec2 position) = 0;
  /// Returns the derivatives of v's place by its position; zero: it does not move that way.
  virtual std::array<Vec, 2> axes(int v) const = 0;
  /// Returns the wanted edge length at a place, > 0.
  virtual double delta(const Vec& place, TrackHint& hint) const = 0;
  /// Returns a unit vector along an arm of the cross on a side of a quad, by its first corner; zero: none.
  virtual Vec arm(int quad, int side, TrackHint& hint) const = 0;
};

/// Moves all vertices of a quad mesh to a minimum of QuadEnergy by L-BFGS (Ceres); the passes are own. In
/// each pass, vertices around the worst quads move first, with a higher weight of bad quads. Then all move;
/// after the first pass, only vertices around quads that are not good yet. `points` has the places of the
/// vertices on their tracks, and is updated. Several threads work on a large mesh block by block
/// (ElementBlocks), each block with its own passes.
///
/// Vertices of flat or inverted quads stay. In each pass vertices move along tangents and are then put on
/// their tracks. Limits hold for each quad: its least sine may fall by half a percent, or to the sine of
/// kOptimisedFloorEta if that is lower. It stays above the least sine of the whole mesh, or that floor. It
/// does not get beyond the limits (is_beyond()). No edge gets shorter than a fifth of its old length, or of
/// delta if that is less. No edge on a curve turns by much more than before, so that holes keep their shape.
/// Vertices that would violate a limit move only a part of the way, or not at all. The same input gives the
/// same mesh.
template <class Vec>
OptimisationSummary optimise_on_tracks(std::vector<Vec>& points, const std::vector<std::array<int, 4>>& quads,
                                       VertexTracks<Vec>& tracks, const OptimisationOptions& options = {});

/// Opens edges without length and untangles inverted or flat quads [escobar2003] with their surroundings.
/// Connectivity and boundary points stay. Returns the number of repaired quads. Throws std::invalid_argument
/// if there are such quads and the input is not conforming.
int untangle_flat(QuadPatch& mesh, const ParametricSize& size);

}  // namespace delquad
