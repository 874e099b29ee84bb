#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "algorithms/regularity/patterns.h"
#include "algorithms/treatment/treatment_moves.h"
#include "base/marks.h"
#include "geometry/mesh/quad_topology.h"

namespace delquad {

/// Scatters the bits of a number (splitmix64).
inline std::uint64_t scattered(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

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

  bool add_around(int vertex) {
    bool good = true;
    mesh_.for_each_out(vertex, [&](int h) { good = good && add(QuadTopology::element(h)); });
    return good;
  }

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
  int irregular() const {
    return static_cast<int>(std::ranges::count_if(vertices_, [&](int v) { return energy_.of(v) > 0; }));
  }

  /// A number that tells cavities apart, and what lies around them.
  std::uint64_t key() const;

 private:
  int quads_at(int v) const {
    return static_cast<std::size_t>(v) < vertex_pass_.size() && vertex_pass_[v] == pass_ ? quads_at_[v] : 0;
  }
  int wanted(int v) const { return energy_.ideal(v) - (mesh_.valence(v) - quads_at(v)); }

  /// Runs of its quads around a vertex.
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

/// How many irregular vertices near one make cavities with it, and among how many vertices they are looked
/// for, for each quad that a cavity may have. With 5, a quarter more cavities on the plate of 16 holes bring
/// nothing.
inline constexpr std::size_t kNear = 4, kMostMet = 3;
/// Rings of quads that a cavity grows by until it has a pattern.
inline constexpr int kMostRings = 2;

/// Grows cavities of a mesh.
class CavitySearch {
 public:
  /// Both outlive this object.
  CavitySearch(const QuadTopology& mesh, const ValenceEnergy& energy)
      : mesh_(mesh), energy_(energy), cavity_(mesh, energy) {}

  Cavity& cavity() { return cavity_; }
  const Cavity& cavity() const { return cavity_; }

  /// Calls consider() for what start() adds to the empty cavity, from there to each of the irregular vertices
  /// nearest to the sources, and to the nearest two, three, ... together. Where start() is false there is
  /// none.
  template <class Start, class F>
  void grow(std::span<const int> sources, int most_quads, Start&& start, F&& consider) {
    find_near(sources, most_quads, [](int) {});
    grow(most_quads, start, consider);
  }
  /// The same from the sources of the last find_near().
  template <class Start, class F>
  void grow(int most_quads, Start&& start, F&& consider) {
    const auto begin = [&] {
      cavity_.begin(most_quads);
      return start();
    };
    if (begin()) consider();
    for (std::size_t j = 0; j < near_.size(); ++j) {
      if (begin() && add_path(near_[j])) consider();
      if (j == 0) continue;
      bool good = begin();
      for (std::size_t i = 0; i <= j && good; ++i) good = add_path(near_[i]);
      if (good) consider();
    }
  }

  /// Adds the quads around `from`, which find_near() met, and those on the way to its source.
  bool add_path(int from);
  /// Adds the quads around the rim of the closed cavity.
  bool add_ring();
  /// Irregular vertices around the sources, the nearest first, as far as quads go from vertex to vertex, at
  /// most so many times as the quads that a cavity may have; each() gets all vertices that are met.
  template <class F>
  void find_near(std::span<const int> sources, int most_quads, F&& each) {
    near_.clear();
    met_.begin(mesh_.vertex_slots());
    from_.resize(mesh_.vertex_slots());
    std::vector<int> queue;
    for (const int v : sources)
      if (met_.meet(v)) from_[v] = v, queue.push_back(v);
    const std::size_t most = kMostMet * static_cast<std::size_t>(most_quads);
    for (std::size_t i = 0; i < queue.size() && queue.size() < most; ++i) {
      const int at = queue[i];
      const auto reach = [&](int w) {
        if (mesh_.held(w) || !met_.meet(w)) return;
        from_[w] = at;
        queue.push_back(w);
        each(w);
        if (energy_.of(w) > 0) near_.push_back(w);
      };
      mesh_.for_each_out(at, [&](int h) {
        reach(mesh_.target(h));
        reach(mesh_.target(mesh_.next(h)));
        reach(mesh_.origin(mesh_.prev(h)));
      });
      if (near_.size() >= kNear) break;
    }
    if (near_.size() > kNear) near_.resize(kNear);
  }

 private:
  const QuadTopology& mesh_;
  const ValenceEnergy& energy_;
  Cavity cavity_;
  std::vector<int> near_;  ///< irregular vertices near the sources, the nearest first
  std::vector<int> from_;  ///< by vertex met: where the search came from
  Marks met_;
};

}  // namespace delquad
