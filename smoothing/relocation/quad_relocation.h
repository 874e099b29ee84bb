#pragma once

#include <cstddef>
#include <vector>

#include "delquad/fields.h"
#include "geometry/mesh/quad_blocks.h"
#include "geometry/mesh/quad_corners.h"
#include "geometry/mesh/quad_topology.h"

namespace delquad {

/// Moves the interior vertices of a quad mesh, one by one, towards right angles and the wanted edge lengths.
///
/// Each vertex lowers
///   sum over the corners that its place changes of  c + 40 max(0, c - 0.95)^2,  c = 1 - sin alpha
/// + 0.12 * sum over its edges of  m^2 / (1 + m^2 / 2),  m = log(l/d),  l the length, d the mean of delta' at
/// both ends (m by a Pade approximant, within 0.2 % from d/2 to 2 d), + 5 n^2 where lengths are held, n by
/// how much m is beyond log kShortWall or log kLongWall, by a damped Newton step that goes 1.4 times as far
/// as Newton's (with fixed neighbours that is too far; as they follow it takes half as many sweeps), at most
/// a part of its shortest edge. c grows with |alpha - 90 degrees| up to 180 degrees, so that reflex and
/// inverted corners are pulled straight. An edge's term is bounded, so that lengths which cannot be had (the
/// boundary's edges are given) do not outweigh shapes. Only vertices near which something still moves are
/// visited.
class QuadRelocation {
 public:
  /// Both arguments outlive this object. delta' is evaluated once a vertex, and anew after a move of a part
  /// of delta'.
  QuadRelocation(QuadTopology& mesh, const ParametricSize& size);

  double delta(int v) const { return delta_[v]; }
  /// Makes delta' known at the vertices that an edit created, `first` and later ones.
  void adopt_new_vertices(int first);

  /// From now on no step may leave more corners around a vertex flat or reflex than there were. A convex star
  /// stays convex in any case; a raw mesh settles better where a tangle may wander.
  void keep_convex_corners() { keep_convex_corners_ = true; }
  /// From now on lengths are held within walls, which are not bounded.
  void hold_lengths() { wall_weight_ = kWallWeight; }
  /// From now on no step takes the least sine of the corners around a vertex below both this and what it was.
  void keep_sines_above(double sine) { kept_sine_ = sine; }

  /// Marks v for the next sweeps (no effect on boundary or dead vertices).
  void activate(int v);
  void activate_all();
  /// Those of the block where there is work to do.
  void activate_all(const QuadBlock& block);
  /// Visits the active vertices until no move exceeds `tolerance` (part of the vertex's shortest edge) or
  /// `max_sweeps` are done. Returns the number of moves.
  long long relax(double tolerance, int max_sweeps);
  /// Lifts the worst elements: while quads below `eta` improve, moves their vertices (and their neighbours')
  /// so that the worst corner around the vertex gets better. Never lowers the least eta around a vertex.
  /// Returns the number of moves.
  long long lift_worst(double eta, int max_sweeps);

  /// One Newton step of v; how far it went, as a part of its shortest edge. 0 for boundary and dead vertices.
  double step(int v);
  /// Moves v, unless the least sine around it is `enough`, to where that is largest nearby; by how much it
  /// grew.
  double lift(int v, double enough);
  /// The sum of crowding_of() over the inner sides of an element. Those that end on the boundary may be as
  /// short as its edges there. Narrow places are where quads reach from one part of it to another.
  double crowding(int element) const { return crowding(element, -1, {}, 0); }
  /// The vertex's part of the objective where it is.
  double cost(int v);
  /// Elements looked at so far around vertices, each time that one was visited: the work done.
  long long looks() const { return looks_; }

 private:
  /// The neighbours of a vertex, one after the other counterclockwise, as seen from anywhere.
  struct Spokes {
    std::vector<double> end_x, end_y;    ///< the neighbour
    std::vector<double> left_x, left_y;  ///< unit vector from it along the side of the element on the spoke's
                                         ///< left that v does not touch
    std::vector<double> right_x, right_y;  ///< same on the right
    std::vector<double> inverse_delta;     ///< of the wanted length
    void resize(std::size_t n);
  };
  /// The spokes as seen from a place of the vertex, the last one once more before the first.
  struct Rays {
    std::vector<double> x, y;     ///< unit vector
    std::vector<double> inverse;  ///< of the length
    std::vector<double> misfit;   ///< log(length / delta), nearly
    void resize(std::size_t n);
  };
  struct Value {
    double cost = 0;
    double least_sine = 1;
    double shortest = 0;  ///< edge
    bool roomy = true;    ///< no side around, as far as it depends on the place, is too short
    int flat = 0;         ///< corners that do not turn left
  };
  /// Lengths of sides.
  struct Lengths {
    double shortest, longest, least_part;  ///< `least_part`: over delta'
  };
  struct Derivatives {
    Vec2 gradient;
    double hxx = 0, hxy = 0, hyy = 0;  ///< positive definite approximation of the second derivatives
  };

  void gather(int v);
  template <bool kDerivatives>
  Value evaluate(Vec2 at, Derivatives* derivatives) const;
  template <class Number>
  Lengths look_from(Vec2 at) const;
  template <class Number, bool kDerivatives>
  Value add_up(Derivatives* derivatives) const;
  bool strays(Vec2 from, Vec2 to) const;
  bool is_narrow(int element) const;
  double crowding(int element, int moved, Vec2 to, double delta_there) const;
  double crowding_around(Vec2 at) const;
  bool crowds(Vec2 from, Vec2 to, const Value& there) const;
  void refresh_delta(int v);
  void activate_ring(int v);

  QuadTopology& mesh_;
  const ParametricSize& size_;
  std::vector<double> delta_;
  std::vector<Vec2> delta_at_;  ///< where delta_ was evaluated
  std::vector<int> hint_;
  std::vector<double> room_;  ///< of boundary vertices: the shorter edge of the boundary
  std::vector<char> narrow_;  ///< of boundary vertices: in a narrow place
  std::vector<char> active_;
  std::vector<int> queue_, visiting_;
  int gathered_ = -1;  ///< the vertex that spokes_ is of
  std::size_t n_spokes_ = 0;
  double shortest_far_ = 0, longest_far_ = 0;  ///< sides around that the vertex does not touch
  Spokes spokes_;                              ///< at least n_spokes_
  mutable Rays rays_;                          ///< evaluate() fills them
  long long looks_ = 0;
  bool keep_convex_corners_ = false;
  double kept_sine_ = -1;
  static constexpr double kWallWeight = 5;
  double wall_weight_ = 0;
};

}  // namespace delquad
