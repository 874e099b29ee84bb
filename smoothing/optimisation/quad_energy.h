// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "delquad/fields.h"
#include "delquad/mesh.h"

// This header has the energy that vertex optimization minimizes. Stage O uses it.

namespace delquad {

/// Weights of the parts of the energy, all >= 0.
struct QuadEnergyWeights {
  double bad = 2;            ///< weight of the second term of quads against the first
  int bad_power = 2;         ///< exponent of the second term
  double size = 0.25;        ///< weight of lengths of edges
  double alignment = 0.02;   ///< weight of directions of edges
  double wall = 80;          ///< weight of lengths beyond the walls
  double orthogonality = 0;  ///< weight of quads whose corners lie on no circle
  double short_wall = QuadLimits{}.short_wall(), long_wall = QuadLimits{}.long_wall();  ///< over delta
};

/// A vertex that moves to its place + x * axes[0] + y * axes[1]. On a curve the second axis is zero.
template <class Vec>
struct MovingVertex {
  int vertex;
  std::array<Vec, 2> axes;
};

/// Input of an energy, in the plane (Vec2) or in space (Vec3), with lengths in one unit.
template <class Vec>
struct QuadEnergyMesh {
  std::vector<Vec> points;
  std::vector<std::array<int, 4>> quads;  ///< counterclockwise; in space as seen from outside
  std::vector<MovingVertex<Vec>> moving;  ///< each vertex at most once
  std::vector<double> delta;              ///< wanted edge length > 0 by vertex
  /// Lengths >= 0 that the sides of each quad, by first corner, should stay well above.
  std::vector<std::array<double, 4>> least_lengths;
  std::vector<double> kept_sine;  ///< sine by quad, in [0, 1]; smaller sines matter less steeply
  std::vector<double> weight;     ///< weight > 0 of each quad's shape
  /// Returns a unit vector along an arm of the cross on a side of a quad, by its first corner; zero: none.
  std::function<Vec(int quad, int side)> arm;
};

/// Energy of vertex optimization (own): the sum of
/// - weight * (s^(1/2) + bad * s^bad_power) over quads, s the sum over corners of 1/sin alpha - 1. The first
///   term is about as linear in |angle - 90 degrees| as eta. The second one protects bad quads from being
///   traded for a better mean.
/// - size * (1 - min(l/d, d/l)) over edges, with length l and mean d of delta at both ends: the loss of an
///   edge in tau.
/// - wall * m^2 / (1 + 16 m^2) over edges, with excess m of log(l/d) over a wall. Angles
///   alone would leave some edges too short or long. The term is bounded, so that lengths forbidden by the
///   model do not outweigh shapes.
/// - orthogonality * sin^2 (alpha_0 + alpha_2) over quads: 0 if the four corners lie on a circle. Then links
///   between circumcenters cross the edges at right angles.
/// - alignment * sin^2 2 phi over edges, phi the angle between edge and cross.
/// - 0.3 * max(0, 1.5 m/l - 1)^2 over edges, m the least length.
/// The first two are rounded off at their kinks. Below the kept sine of a quad, at least 0.15, 1/sin alpha
/// continues as its Taylor polynomial of degree two. So the energy is finite for inverted quads, and no quad
/// blocks the others. Corners with three fixed vertices do not count. In space, the angle of a corner lies
/// between its sides, and is reflex if it turns against the initial normal of its quad.
///
/// Variables: x, y of each moving vertex, in multiples of its axes.
template <class Vec>
class QuadEnergy {
 public:
  /// Lists of the mesh must have one entry for each vertex, or for each quad.
  QuadEnergy(QuadEnergyMesh<Vec> mesh, const QuadEnergyWeights& weights);

  int variables() const { return 2 * static_cast<int>(moving_.size()); }
  /// Computes the energy and, unless null, its gradient. Returns false if the energy is infinite: an edge has
  /// no length. It runs on several threads, with the same result for any number; only one call at a time is
  /// allowed.
  bool evaluate(const double* x, double& energy, double* gradient) const;
  /// Returns all points of the mesh after a displacement by variables().
  std::vector<Vec> points(const double* x) const;

 private:
  struct Quad {
    std::array<int, 4> sides;  ///< indices of sides; complements if they run the other way
    std::uint32_t movable;     ///< a bit for each corner
    Vec normal;                ///< in space
    double knee, weight;
    bool moves(int k) const { return (movable >> k & 1U) != 0; }
  };
  /// A side of one or two quads of a piece, and its state at each evaluation.
  struct Side {
    int a, b;  ///< slots
  };
  struct SideState {
    Vec u;  ///< unit vector from a to b
    double inverse, length;
    Vec slope;  ///< derivative of the energy by the vector from a to b
  };
  struct Edge {
    int side;
    double inverse_length;  ///< inverse of the wanted length
    double least_length;
    Vec arm;
  };
  /// Consecutive quads with their sides, the edges first met on them, and a slot for each of their vertices.
  /// It is the work of one thread, and begins at the end of the previous piece.
  struct Piece {
    std::size_t quads_end, edges_end, slots_end, sides_end;
  };
  struct Slot {
    int vertex, moving;  ///< `moving`: index among moving vertices; -1: it stays
  };

  void add_pieces(const QuadEnergyMesh<Vec>& mesh);
  void add_slots(std::size_t quads_begin, std::size_t edges_begin, const std::vector<int>& moving);
  void add_sides(std::size_t quads_begin, std::size_t edges_begin, std::size_t slots_begin);
  void find_slots_of_moving();
  Vec place(int moving, const double* x) const;
  double piece_energy(std::size_t piece, const double* x) const;
  double add_quad(const Quad& quad) const;
  double add_edge(const Edge& edge) const;

  QuadEnergyWeights weights_;
  std::vector<Vec> start_;
  std::vector<MovingVertex<Vec>> moving_;
  std::vector<Quad> quads_;
  std::vector<Edge> edges_;
  std::vector<int> slot_of_;              ///< last slot of each vertex
  std::vector<std::array<int, 2>> ends_;  ///< ends of edges: vertices, then slots, until sides are known
  std::vector<Side> sides_;
  std::vector<Slot> slots_;
  std::vector<Piece> pieces_;
  std::vector<std::size_t> first_slot_;  ///< index into slots_of_moving_ for each moving vertex
  std::vector<int> slots_of_moving_;
  mutable std::vector<Vec> at_, slope_;    // by slot; entries of fixed vertices in at_ never change
  mutable std::vector<SideState> states_;  // by side
  mutable std::vector<double> energies_;   // by piece
};

struct EnergyDescent {
  std::vector<double> x;  ///< minimizer
  int iterations = 0, evaluations = 0;
  double energy_before = 0, energy_after = 0;
};

/// Lowers the energy from x = 0, where it must be finite, by L-BFGS (Ceres), in at most `max_iterations`.
template <class Vec>
EnergyDescent minimise(const QuadEnergy<Vec>& energy, int max_iterations);

}  // namespace delquad
