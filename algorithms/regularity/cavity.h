#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "algorithms/treatment/treatment_moves.h"
#include "geometry/mesh/quad_topology.h"

namespace delquad {

/// Quads that other quads may replace. A vertex of the rim wants so many quads inside as its ideal valence is
/// more than its quads outside: one at a corner, two on a side. A closed cavity has no others, but for
/// concave vertices of the boundary, and its rim is one loop.
class Cavity {
 public:
  /// Both outlive this object.
  Cavity(const QuadTopology& mesh, const ValenceEnergy& energy) : mesh_(mesh), energy_(energy) {}

  /// Empty, and never more than `most` quads.
  void begin(int most);
  /// False, here and below: it would have a triangle, a held vertex or too many quads. It can be no cavity
  /// then.
  bool add(int element);
  bool add_around(int vertex);
  /// Adds the quads at vertices of the rim that want none, or three and more, as long as there are any.
  /// False, too, where the boundary is too concave, or the rim no loop with 2 to 8 corners (concave ones
  /// taken off).
  bool close();

  std::span<const int> elements() const { return elements_; }
  /// All vertices, also of the rim.
  std::span<const int> vertices() const { return vertices_; }
  /// Of a closed one: the half-edges of the rim counterclockwise, and 2 - (quads wanted) of their origins.
  std::span<const int> rim() const { return rim_; }
  std::span<const int> turns() const { return turns_; }
  int corners() const { return corners_; }
  bool is_inside(int vertex) const {
    return !mesh_.on_boundary(vertex) && quads_at(vertex) == mesh_.valence(vertex);
  }
  bool has(int element) const {
    return static_cast<std::size_t>(element) < element_pass_.size() && element_pass_[element] == pass_;
  }
  /// How many of its vertices are irregular.
  int irregular() const;
  /// A number that tells cavities apart, and what lies around them.
  std::uint64_t key() const;

 private:
  int quads_at(int v) const {
    return static_cast<std::size_t>(v) < vertex_pass_.size() && vertex_pass_[v] == pass_ ? quads_at_[v] : 0;
  }
  int wanted(int v) const { return energy_.ideal(v) - (mesh_.valence(v) - quads_at(v)); }
  int fans_at(int v) const;
  bool trace();

  const QuadTopology& mesh_;
  const ValenceEnergy& energy_;
  std::size_t most_ = 0;
  unsigned pass_ = 0;
  std::vector<unsigned> element_pass_, vertex_pass_;  ///< the last pass in which each was met
  std::vector<int> quads_at_;                         ///< by vertex of this pass
  std::vector<int> checked_at_;                       ///< and how many there were when it was checked last
  std::vector<int> elements_, vertices_, to_check_, rim_, turns_;
  int corners_ = 0;  ///< sum of the turns
};

}  // namespace delquad
