#pragma once

#include <array>
#include <vector>

#include "fields/cross_field.h"
#include "mesh/patch.h"

namespace delquad {

/// How the parts of the energy are weighed against each other.
struct QuadEnergyWeights {
  double bad = 2;           ///< of the quads' second term, against the first
  double bad_power = 2;     ///< its exponent
  double size = 0.25;       ///< of the edges' lengths
  double alignment = 0.02;  ///< of the edges' directions
  double barrier = 0.002;   ///< of the corners' barrier
};

/// What vertex optimisation minimises: the sum of
///   s^(1/2) + bad * s^bad_power over the quads, s the sum over the corners of 1/sin alpha - 1: the first
///   term
///     is about as linear in |angle - 90 degrees| as eta is, the second keeps the mean from being bought with
///     some bad quads,
///   size * (1 - exp(-|log(l/d)|)) over the edges, l the length, d the mean of delta' at both ends: what an
///     edge lacks in tau,
///   alignment * (1 - cos 4(phi - theta)) / 2 over the edges, phi the edge's direction and theta the cross's,
///   barrier * -log(sin alpha - least sine) over the corners,
/// the first two rounded off where they have a kink. The energy is infinite where a corner's sine does not
/// exceed the least sine. Corners whose three vertices stay do not count.
///
/// Variables: the free vertices' displacement from the mesh's places, x then y of each, over delta' there.
class QuadEnergy {
 public:
  /// By vertex: whether it moves, delta' and the cross. Corners and edges without a free vertex do not count.
  QuadEnergy(const QuadPatch& mesh, const std::vector<char>& free, const std::vector<double>& delta,
             const std::vector<Cross>& cross, double least_sine, const QuadEnergyWeights& weights);

  int variables() const { return 2 * static_cast<int>(free_.size()); }
  /// False where the energy is infinite. `gradient` may be null.
  bool evaluate(const double* displacement, double& energy, double* gradient) const;
  /// All points of the mesh after a displacement.
  std::vector<Vec2> points(const double* displacement) const;

 private:
  struct Quad {
    std::array<int, 4> vertices;
    unsigned movable;  ///< a bit for each corner
    bool moves(int k) const { return (movable >> k & 1U) != 0; }
  };
  struct Edge {
    int a, b;
    double length;  ///< wanted
    Cross cross;    ///< of unit length, or zero
  };

  bool add_quad(const Quad& quad, const std::vector<Vec2>& at, double& energy,
                std::vector<Vec2>* slope) const;
  void add_edge(const Edge& edge, const std::vector<Vec2>& at, double& energy,
                std::vector<Vec2>* slope) const;

  QuadEnergyWeights weights_;
  double least_sine_;
  std::vector<Vec2> start_;
  std::vector<int> free_;      ///< vertices
  std::vector<double> scale_;  ///< delta' of each
  std::vector<Quad> quads_;
  std::vector<Edge> edges_;
};

}  // namespace delquad
