// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <unordered_set>
#include <utility>
#include <vector>

#include "algorithms/regularity/across_curves.h"
#include "algorithms/regularity/cavity.h"
#include "algorithms/regularity/patterns.h"
#include "algorithms/regularity/polygon_sides.h"
#include "smoothing/relocation/quad_relocation.h"

// This header has the state of patches and curves during make_regular_across_curves(). Its visits use it.

namespace delquad::across {

/// A stretch of a curve between nodes `low` and `high` that gets `by` more edges, or fewer if negative. Nodes
/// between `from` and `to` move to make space.
struct Change {
  int curve, low, high, by;
  int from = 0, to = 0;
  int side = 0;  ///< its side of a simple polygon
  /// Returns the final number of edges between `from` and `to`.
  int edges() const { return to - from + by; }  ///< final edges between `from` and `to`
  /// Returns the new index, counted from `from`, of a node that stays.
  int index(int k) const { return k - from + (k < high ? 0 : by); }
  bool moves(int k) const { return (from < k && k <= low) || (high <= k && k < to); }
};

inline std::uint64_t hash_combine(std::uint64_t sum, std::uint64_t value) {
  return hash_bits(sum ^ hash_bits(value));
}
inline std::uint64_t hash_combine(std::uint64_t sum, const Change& c) {
  for (const int value : {c.curve, c.low, c.high, c.by})
    sum = hash_combine(sum, static_cast<std::uint64_t>(static_cast<unsigned>(value)));
  return sum;
}

/// Quads of a patch that make a closed cavity.
struct Polygon {
  std::vector<int> elements;
  std::vector<Change> runs;           ///< unchanged stretches on its rim, one for each curve
  std::optional<PolygonSides> sides;  ///< none if it is concave or has six corners or more
  int irregular;
  std::uint64_t key;
};

/// A polygon with changed stretches.
struct Use {
  const Polygon* polygon;
  std::vector<Change> changes;
  int left;  ///< irregular vertices of its pattern
  int more() const { return left - polygon->irregular; }
  std::size_t quads() const { return polygon->elements.size(); }
  friend bool operator<(const Use& a, const Use& b) {
    return a.more() != b.more() ? a.more() < b.more() : a.quads() < b.quads();
  }
};
/// Uses of a patch beside a stretch: `ends` finish a change, `ways` pass it on.
struct Uses {
  std::vector<Use> ends, ways;
};

/// Rim of a cavity after its stretches have changed.
struct Rim {
  Outline outline;
  std::vector<int> vertex;    ///< vertex of the patch; negative: new node
  std::map<int, Vec2> moved;  ///< moved boundary points of the patch
  std::set<int> gone;         ///< removed boundary points of the patch
};

/// Current state of a patch for all threads.
class PatchWork {
 public:
  PatchWork(PatchAtCurves& of, std::uint64_t number)
      : patch(of), mesh(of.mesh), energy(mesh), relocation(mesh, *of.size), version(number) {
    for (std::size_t i = 0; i < patch.edges.size(); ++i)
      if (patch.edges[i].curve >= 0) {
        const auto [at, is_new] = first_.try_emplace(patch.edges[i].curve, static_cast<int>(i), 1);
        if (!is_new) ++at->second.second;
      }
  }

  double delta(int v) const { return relocation.delta(v); }
  /// Returns the boundary point where the curve's k-th edge begins in this patch.
  int edge_point(int curve, int k) const {
    const auto [first, n] = first_.at(curve);
    return patch.edges[first].forward ? first + k : first + n - 1 - k;
  }
  /// Returns the boundary point at the curve's k-th node in this patch.
  int node_point(int curve, int k) const {
    const auto [first, n] = first_.at(curve);
    if (patch.edges[first].forward) return k < n ? first + k : mesh.target(mesh.out(first + n - 1));
    return k > 0 ? first + n - k : mesh.target(mesh.out(first + n - 1));
  }
  int edge_element(int curve, int k) const { return QuadTopology::element(mesh.out(edge_point(curve, k))); }
  /// Returns the edge that begins at a half-edge's origin; its curve is negative if no curve has it.
  CurveEdge edge_of(int h) const {
    if (mesh.twin(h) >= 0) return {};
    return patch.edges[mesh.origin(h)];
  }
  /// Returns the known value, or calls `make`, which returns the same on every thread.
  template <class Map, class Make>
  const typename Map::mapped_type& known(Map& all, const typename Map::key_type& key, Make&& make) {
    {
      const std::scoped_lock held(lock_);
      if (const auto at = all.find(key); at != all.end()) return at->second;
    }
    auto made = make();
    const std::scoped_lock held(lock_);
    return all.try_emplace(key, std::move(made)).first->second;
  }

  PatchAtCurves& patch;
  QuadTopology mesh;
  ValenceEnergy energy;
  QuadRelocation relocation;
  const std::uint64_t version;
  std::map<std::array<int, 3>, std::vector<Polygon>> polygons;  ///< by stretch
  std::map<std::array<int, 4>, Uses> uses;                      ///< by stretch and change

 private:
  std::map<int, std::pair<int, int>> first_;  ///< first boundary point and number of edges of each curve here
  std::mutex lock_;
};

/// Data that visits share.
struct Shared {
  const CurveNetwork& network;
  const RegularityOptions& options;
  std::vector<std::unique_ptr<PatchWork>> works;  ///< of patches that take part
  std::unordered_set<std::uint64_t> lost;         ///< candidates that were tried

  bool may_cross(const CurveEdge& e) const { return e.curve >= 0 && network.sides[e.curve][0] >= 0; }

  /// Returns the parameters of the nodes from `from` to `to` after the change.
  std::vector<double> new_places(const Change& change) const {
    const auto& nodes = network.nodes[change.curve];
    const int n = change.edges();
    std::vector<double> places;
    for (int i = 0; i <= n; ++i) {
      const double at = change.from + double(i) * (change.to - change.from) / n;
      const int k = std::min(static_cast<int>(at), change.to - 1);
      places.push_back(nodes[k] + (at - k) * (nodes[k + 1] - nodes[k]));
    }
    return places;
  }
};

/// Grows cavities of patches, for one thread at a time.
class SearchPool {
 public:
  CavitySearch& of(PatchWork& w, int patch) {
    if (of_.size() <= static_cast<std::size_t>(patch)) of_.resize(patch + 1);
    auto& [version, search] = of_[patch];
    if (!search || version != w.version) {
      version = w.version;
      search = std::make_unique<CavitySearch>(w.mesh, w.energy);
    }
    return *search;
  }
  /// Makes the polygon the cavity of the patch. Returns null if it no longer exists.
  const Cavity* take(PatchWork& w, int patch, const std::vector<int>& elements) {
    Cavity& cavity = of(w, patch).cavity();
    cavity.begin(static_cast<int>(elements.size()));
    for (const int e : elements) cavity.add(e);
    return cavity.close() ? &cavity : nullptr;
  }

 private:
  std::vector<std::pair<std::uint64_t, std::unique_ptr<CavitySearch>>> of_;  ///< by patch
};

}  // namespace delquad::across
