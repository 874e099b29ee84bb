// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "algorithms/treatment/treatment_moves.h"
#include "base/marks.h"
#include "geometry/mesh/quad_topology.h"

// This header has cavities, which are sets of quads to replace, and the search for them. Stage Q uses it.

namespace delquad {

/// Scatters the bits of a number (splitmix64).
inline std::uint64_t hash_bits(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// Set of quads that may be replaced. A rim vertex wants its ideal valence minus its quads outside: one quad
/// at a corner, two on a side. In a closed cavity every rim vertex wants one or two, except concave ones of
/// the boundary, and the rim is one loop.
class Cavity {
 public:
  /// Both must outlive this object.
  Cavity(const QuadTopology& mesh, const ValenceEnergy& energy) : mesh_(mesh), energy_(energy) {}

  /// Empties the cavity, and limits it to `most` > 0 quads.
  void begin(int most);

  /// Adds an element. Returns false, here and below, if the set would have a triangle, a held vertex or too
  /// many quads. It cannot become a cavity then.
  bool add(int element);

  bool add_around(int vertex) {
    bool good = true;
    mesh_.for_each_out(vertex, [&](int h) { good = good && add(QuadTopology::element(h)); });
    return good;
  }

  /// Adds quads at rim vertices that want none, or three and more, until none are left. Returns also false if
  /// the boundary is too concave, or the rim is no loop with 2 to 8 corners (minus concave ones).
  bool close();

  std::span<const int> elements() const { return elements_; }
  /// Returns all vertices, rim included.
  std::span<const int> vertices() const { return vertices_; }
  /// Return, for a closed cavity, the half-edges of the rim counterclockwise, and 2 - (wanted quads) at their
  /// origins.
  std::span<const int> rim() const { return rim_; }
  std::span<const int> turns() const { return turns_; }
  int corners() const { return corners_; }
  /// Returns whether all quads at a vertex are in the cavity, and it is not on the boundary of the mesh.
  bool is_inside(int vertex) const {
    return !mesh_.on_boundary(vertex) && quads_at(vertex) == mesh_.valence(vertex);
  }
  bool has(int element) const {
    return static_cast<std::size_t>(element) < element_pass_.size() && element_pass_[element] == pass_;
  }

  /// Returns the number of its irregular vertices.
  int irregular() const {
    return static_cast<int>(std::ranges::count_if(vertices_, [&](int v) { return energy_.of(v) > 0; }));
  }

  /// Returns a hash of the cavity and its surroundings.
  std::uint64_t key() const;

 private:
  int quads_at(int v) const {
    return static_cast<std::size_t>(v) < vertex_pass_.size() && vertex_pass_[v] == pass_ ? quads_at_[v] : 0;
  }
  int wanted(int v) const { return energy_.ideal(v) - (mesh_.valence(v) - quads_at(v)); }

  /// Returns the number of runs of its quads around a vertex.
  int fans_at(int v) const;

  bool trace();

  const QuadTopology& mesh_;
  const ValenceEnergy& energy_;
  std::size_t most_ = 0;
  unsigned pass_ = 0;
  std::vector<unsigned> element_pass_, vertex_pass_;  ///< last pass that met each element or vertex
  std::vector<int> quads_at_;                         ///< by vertex of this pass
  std::vector<int> checked_at_;                       ///< number of quads at its last check
  std::vector<int> elements_, vertices_, to_check_, rim_, turns_;
  int corners_ = 0;  ///< sum of the turns
};

/// Most near irregular vertices that make cavities with one, and most searched vertices for each quad that a
/// cavity may have. With 5, a quarter more cavities on the plate of 16 holes bring nothing.
inline constexpr std::size_t kNear = 4, kMostMet = 3;
/// Limit of rings of quads that a cavity adds until it has a pattern.
inline constexpr int kMostRings = 2;

/// Search that grows cavities of a mesh (own, after the cavities of [reberol2021]).
class CavitySearch {
 public:
  /// Both must outlive this object.
  CavitySearch(const QuadTopology& mesh, const ValenceEnergy& energy)
      : mesh_(mesh), energy_(energy), cavity_(mesh, energy) {}

  Cavity& cavity() { return cavity_; }
  const Cavity& cavity() const { return cavity_; }

  /// Calls consider() for the cavity around a vertex. Does so with each near irregular vertex, too, and with
  /// the nearest two, three and so on.
  template <class F>
  void grow(int v, int most_quads, F&& consider) {
    find_near(v, most_quads);
    const auto begin = [&] {
      cavity_.begin(most_quads);
      return cavity_.add_around(v);
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

  /// Adds the quads around the rim of the closed cavity.
  bool add_ring();

 private:
  /// Adds the quads around `from`, which find_near() met, and around the path to its source.
  bool add_path(int from);
  /// Finds irregular vertices near a vertex, nearest first, in steps from vertex to vertex through quads.
  /// It visits at most kMostMet * most_quads vertices.
  void find_near(int source, int most_quads) {
    near_.clear();
    met_.begin(mesh_.vertex_slots());
    from_.resize(mesh_.vertex_slots());
    std::vector<int> queue{source};
    met_.meet(source), from_[source] = source;
    const std::size_t most = kMostMet * static_cast<std::size_t>(most_quads);
    for (std::size_t i = 0; i < queue.size() && queue.size() < most; ++i) {
      const int at = queue[i];
      const auto reach = [&](int w) {
        if (mesh_.held(w) || !met_.meet(w)) return;
        from_[w] = at;
        queue.push_back(w);
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

  const QuadTopology& mesh_;
  const ValenceEnergy& energy_;
  Cavity cavity_;
  std::vector<int> near_;  ///< irregular vertices near the source, nearest first
  std::vector<int> from_;  ///< by met vertex: its predecessor in the search
  Marks met_;
};

}  // namespace delquad
