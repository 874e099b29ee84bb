#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// How the parts of the energy are weighed against each other.
struct QuadEnergyWeights {
  double bad = 2;            ///< of the quads' second term, against the first
  int bad_power = 2;         ///< its exponent
  double size = 0.25;        ///< of the edges' lengths
  double alignment = 0.02;   ///< of the edges' directions
  double wall = 80;          ///< of lengths beyond the walls
  double orthogonality = 0;  ///< of quads whose corners lie on no circle
};

/// A vertex that moves, to its place + x * axes[0] + y * axes[1]. Along a curve: the second axis is zero.
template <class Vec>
struct MovingVertex {
  int vertex;
  std::array<Vec, 2> axes;
};

/// What an energy is made of, in the plane (Vec2) or in space (Vec3).
template <class Vec>
struct QuadEnergyMesh {
  std::vector<Vec> points;
  std::vector<std::array<int, 4>> quads;  ///< counterclockwise, in space: seen from outside
  std::vector<MovingVertex<Vec>> moving;  ///< each vertex once at most
  std::vector<double> delta;              ///< wanted edge length, by vertex
  /// That a quad's sides (by their first corner) should not come near to.
  std::vector<std::array<double, 4>> least_lengths;
  std::vector<double> kept_sine;  ///< of the corners, by quad: what is below it matters less steeply
  std::vector<double> weight;     ///< of the quads' shapes
  /// Unit vector along one arm of the cross on a quad's side (by its first corner); zero: none.
  std::function<Vec(int quad, int side)> arm;
};

/// What vertex optimisation minimises: the sum of
///   weight * (s^(1/2) + bad * s^bad_power) over the quads, s the sum over the corners of 1/sin alpha - 1:
///   the first term
///     is about as linear in |angle - 90 degrees| as eta is, the second keeps the mean from being bought with
///     some bad quads,
///   size * (1 - min(l/d, d/l)) over the edges, l the length, d the mean of delta at both ends: what an edge
///     lacks in tau,
///   wall * m^2 / (1 + 16 m^2) over the edges, m by how much log(l/d) is beyond kShortWall or kLongWall, as
///     angles alone would leave some edges too short or long; they level off, since lengths that the model
///     forbids are not to outweigh shapes,
///   orthogonality * sin^2 (alpha_0 + alpha_2) over the quads, 0 where the four corners lie on a circle: the
///   links
///     between centres of such circles cross the edges at right angles,
///   alignment * sin^2 2 phi over the edges, phi the angle between edge and cross,
///   .3 * max(0, 1.5 m/l - 1)^2 over the edges, m the least length,
/// the first two rounded off where they have a kink. Below a quad's kept sine, or .15 where that is less,
/// 1/sin alpha goes on as its Taylor polynomial of the second degree: the energy is finite even where quads
/// are inverted, so that no quad holds up the steps of all others. Corners whose three vertices stay do not
/// count. In space a corner's angle is that between its sides, reflex where it turns against the normal that
/// its quad had at the start.
///
/// Variables: x, y of each moving vertex.
template <class Vec>
class QuadEnergy {
 public:
  QuadEnergy(QuadEnergyMesh<Vec> mesh, const QuadEnergyWeights& weights);

  int variables() const { return 2 * static_cast<int>(moving_.size()); }
  /// False where the energy is infinite: an edge has no length. `gradient` may be null. Works on several
  /// threads, with the same result for every number of them; not to be called from two at once.
  bool evaluate(const double* x, double& energy, double* gradient) const;
  /// All points of the mesh after a displacement.
  std::vector<Vec> points(const double* x) const;

 private:
  struct Quad {
    std::array<int, 4> sides;  ///< their numbers, or the complements of these where they run the other way
    std::uint32_t movable;     ///< a bit for each corner
    Vec normal;                ///< in space
    double knee, weight;
    bool moves(int k) const { return (movable >> k & 1U) != 0; }
  };
  /// A side of one quad or two of a piece, and what is known of it at each evaluation.
  struct Side {
    int a, b;  ///< slots
  };
  struct SideState {
    Vec u;  ///< unit vector from a to b
    double inverse, length;
    Vec slope;  ///< of the energy, against the vector from a to b
  };
  struct Edge {
    int side;
    double inverse_length;  ///< wanted
    double least_length;
    Vec arm;
  };
  /// Some quads that follow each other, their sides, the edges first seen on them, and a slot for each of
  /// their vertices: one thread's work. It begins where the piece before ends.
  struct Piece {
    std::size_t quads_end, edges_end, slots_end, sides_end;
  };
  struct Slot {
    int vertex, moving;  ///< `moving`: its number among those that move, -1: it stays
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
  std::vector<int> slot_of_;              ///< by vertex: its last one
  std::vector<std::array<int, 2>> ends_;  ///< vertices, then slots, of the edges until their sides are known
  std::vector<Side> sides_;
  std::vector<Slot> slots_;
  std::vector<Piece> pieces_;
  std::vector<std::size_t> first_slot_;  ///< into slots_of_moving_, of each moving vertex
  std::vector<int> slots_of_moving_;
  mutable std::vector<Vec> at_, slope_;    // by slot; where nothing moves, at_ never changes
  mutable std::vector<SideState> states_;  // by side
  mutable std::vector<double> energies_;   // by piece
};

struct EnergyDescent {
  std::vector<double> x;  ///< where the energy is least
  int iterations = 0, evaluations = 0;
  double energy_before = 0, energy_after = 0;
};

/// Lowers the energy from x = 0, where it must be finite, by L-BFGS (Ceres).
template <class Vec>
EnergyDescent minimise(const QuadEnergy<Vec>& energy, int max_iterations);

}  // namespace delquad
