// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "delquad/fields.h"
#include "geometry/mesh/quad_blocks.h"
#include "geometry/mesh/quad_corners.h"
#include "geometry/mesh/quad_topology.h"

// This header relocates vertices one by one. The treatment, clean-up, stage Q and repairs use it.

namespace delquad {

/// Moves the interior vertices of a quad mesh one by one towards right angles and wanted lengths, in the
/// parameter plane. The method is own.
///
/// Each vertex lowers a sum. Over corners that its place changes and over its edges, the terms are
/// - c + 40 max(0, c - 0.95)^2 with c = 1 - sin alpha;
/// - 0.12 m^2 / (1 + m^2 / 2) with m = log(l/d), length l, and mean d of delta' at both ends;
/// - 5 n^2 if lengths are held, with the excess n of m over the logarithms of the walls.
/// A Pade approximant gives m, within 0.2 % from d/2 to 2 d. The vertex takes a damped Newton step of 1.4
/// times its length, at most a part of its shortest edge. That is too far for fixed neighbors, but since they
/// follow it needs half as many sweeps. The value c grows with |alpha - 90 degrees| up to 180 degrees, so
/// reflex and inverted corners straighten. An edge's term is bounded, so impossible lengths at the given
/// boundary do not outweigh shapes. Only vertices near recent moves are visited.
class QuadRelocation {
 public:
  /// Both arguments must outlive this object. delta' is evaluated once for each vertex, and again after a
  /// move of a part of delta'.
  QuadRelocation(QuadTopology& mesh, const ParametricSize& size);

  /// Returns delta' at a vertex.
  double delta(int v) const { return delta_[v]; }
  const QuadLimits& limits() const { return size_.limits; }
  /// Evaluates delta' at new vertices, `first` and later ones.
  void adopt_new_vertices(int first);

  /// Forbids steps that make more corners around a vertex flat or reflex. A convex star always stays convex;
  /// without this, a raw mesh settles better, since a tangle may wander.
  void keep_convex_corners() { keep_convex_corners_ = true; }
  /// Holds lengths within walls, by a term without bound.
  void hold_lengths() { wall_weight_ = kWallWeight; }
  /// Forbids steps that take the least sine around a vertex below both this, in [-1, 1], and its old value.
  void keep_sines_above(double sine) { kept_sine_ = sine; }

  /// Marks v for the next sweeps, unless it is on the boundary or dead.
  void activate(int v);
  /// Marks all vertices inside of the mesh.
  void activate_all();
  /// Marks the vertices of a block that it works on.
  void activate_all(const QuadBlock& block);
  /// Visits active vertices until no move exceeds `tolerance` (in shortest edges of the vertex), or
  /// `max_sweeps` are done. Returns the number of moves.
  long long relax(double tolerance, int max_sweeps);
  /// Lifts the worst elements. While quads below `eta`, in [0, 1], improve, their vertices and neighbors move
  /// to raise the worst corner around them. The least eta around a vertex never falls. Returns the number of
  /// moves.
  long long lift_worst(double eta, int max_sweeps);

  /// Makes a Newton step of v. Returns its length in shortest edges of v; 0 on the boundary or if v is dead.
  double step(int v);
  /// Moves v to the largest least sine around it nearby, unless this sine is at least `enough`. Returns its
  /// growth, >= 0.
  double lift(int v, double enough);
  /// Returns the sum of crowding_of() over the inner sides of an element. Sides that end on the boundary may
  /// be as short as its edges. In narrow places quads reach across the domain.
  double crowding(int element) const { return crowding(element, -1, {}, 0); }
  /// Returns the sum above for a vertex at its place.
  double cost(int v);
  /// Returns the number of elements around visited vertices, with repetition: the work done.
  long long looks() const { return looks_; }

 private:
  /// Neighbors of a vertex, counterclockwise, independent of its place.
  struct Spokes {
    std::vector<double> end_x, end_y;      ///< neighbor
    std::vector<double> left_x, left_y;    ///< unit vector from it along the side of the left element that v
                                           ///< does not touch
    std::vector<double> right_x, right_y;  ///< the same on the right
    std::vector<double> inverse_delta;     ///< of the wanted length
    void resize(std::size_t n);
  };
  /// The spokes from a place of the vertex, with the last one repeated before the first.
  struct Rays {
    std::vector<double> x, y;     ///< unit vector
    std::vector<double> inverse;  ///< of the length
    std::vector<double> misfit;   ///< log(length / delta), approximately
    void resize(std::size_t n);
  };
  struct Value {
    double cost = 0;
    double least_sine = 1;
    double shortest = 0;  ///< shortest edge
    bool roomy = true;    ///< whether all sides around that depend on the place are long enough
    int flat = 0;         ///< corners that do not turn left
  };
  /// Lengths of sides.
  struct Lengths {
    double shortest, longest, least_part;  ///< `least_part` is over delta'
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
  /// Returns whether a step leaves the region of the vertex.
  bool strays(Vec2 from, Vec2 to) const;
  bool is_narrow(int element) const;
  double crowding(int element, int moved, Vec2 to, double delta_there) const;
  double crowding_around(Vec2 at) const;
  bool crowds(Vec2 from, Vec2 to, const Value& there) const;
  void refresh_delta(int v);
  void activate_ring(int v);

  QuadTopology& mesh_;
  const ParametricSize& size_;
  const double short_misfit_, long_misfit_;  ///< logarithms of the walls
  std::vector<double> delta_;
  std::vector<Vec2> delta_at_;  ///< place of the evaluation of delta_
  std::vector<int> hint_;
  std::vector<double> room_;  ///< by boundary vertex: the shorter edge of the boundary
  std::vector<char> narrow_;  ///< by boundary vertex: whether it is in a narrow place
  std::vector<char> active_;
  std::vector<int> queue_, visiting_;
  int gathered_ = -1;  ///< vertex of spokes_
  std::size_t n_spokes_ = 0;
  double shortest_far_ = 0, longest_far_ = 0;  ///< sides around that the vertex does not touch
  Spokes spokes_;                              ///< at least n_spokes_ entries
  mutable Rays rays_;                          ///< set by evaluate()
  long long looks_ = 0;
  bool keep_convex_corners_ = false;
  double kept_sine_ = -1;
  static constexpr double kWallWeight = 5;
  double wall_weight_ = 0;
};

}  // namespace delquad
