// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/regularity.h"

#include <algorithm>
#include <cstdlib>
#include <numbers>
#include <tuple>
#include <unordered_map>

#include "base/cancel.h"
#include "geometry/mesh/open_quads.h"
#include "geometry/mesh/quad_corners.h"
#include "metrics/shape.h"

namespace delquad {
namespace {

/// Nodes of a mesh cut open, and the number of missing quads at each.
class Charges {
 public:
  Charges(const Mesh& mesh, std::span<const HalfEdge> sides)
      : mesh_(mesh), quads_(mesh, sides), charge_(quads_.size()), total_(quads_.n_patches(), 0) {
    const ElementSides up(mesh);
    // Sum of ideals at each point; 0: not inside the mesh.
    std::vector<int> ideal(mesh.points.size(), 0);
    for (int node = 0; node < quads_.size(); ++node) {
      const int of_node = quads_.inside(node) ? 4 : ideal_quads(angle(node, up) / (std::numbers::pi / 2));
      charge_[node] = of_node - quads_.quads_at(node);
      ideal[point(node)] += of_node;
      total_[patch(node)] += charge_[node];
    }
    for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
      if (edge.size() != 2) ideal[edge[0].lo] = ideal[edge[0].hi] = 0;
    });
    for (const int charge : charge_) beyond_ += std::abs(charge);
    for (const int total : total_) necessary_ += std::abs(total);
    beyond_ -= necessary_;
    for (const int of_point : ideal) necessary_ += of_point > 0 ? std::abs(4 - of_point) : 0;
  }

  const OpenQuads& quads() const { return quads_; }
  const std::vector<int>& charge() const { return charge_; }
  int point(int node) const { return mesh_.quads[quads_.quad(quads_.out(node))][quads_.out(node) & 3]; }
  Vec3 at(int node) const { return mesh_.points[point(node)]; }
  /// Returns the sum of charges in the node's patch.
  int total(int node) const { return total_[patch(node)]; }
  int necessary() const { return necessary_; }
  int beyond() const { return beyond_; }

 private:
  int patch(int node) const { return quads_.patch(quads_.quad(quads_.out(node))); }
  double angle(int node, const ElementSides& up) const {
    double sum = 0;
    quads_.for_each_out(node, [&](int h) { sum += quad_shape(mesh_, quads_.quad(h), up).angle[h & 3]; });
    return sum;
  }

  const Mesh& mesh_;
  OpenQuads quads_;
  std::vector<int> charge_;  // by node
  std::vector<int> total_;   // by patch
  int necessary_ = 0, beyond_ = 0;
};

auto key_of(const Vec3& p) { return std::tuple(p.x, p.y, p.z); }

struct Candidate {
  int from, to;  ///< nodes
  int edges;
  double length;
  std::array<int, 2> burgers;
};

/// Search for shortest paths from a node, edge by edge.
class PathSearch {
 public:
  PathSearch(const Charges& charges, int source) : charges_(&charges), source_(source), front_({source}) {
    reached_[source];
  }

  int source() const { return source_; }
  bool is_done() const { return front_.empty(); }

  /// Goes one edge farther. Adds met nodes of opposite charge to `met`.
  void step(std::vector<Candidate>& met) {
    ++edges_;
    std::vector<int> next;
    for (const int node : front_) leave(node, next);
    const auto& charge = charges_->charge();
    const auto is_irregular = [&](int node) { return charge[node] != 0; };
    for (const int node : next)
      if (is_irregular(node) && (charge[node] > 0) != (charge[source_] > 0)) {
        const Reached& r = reached_.at(node);
        const int one = std::abs(r.x + r.y), other = std::abs(r.x - r.y);
        met.push_back({source_, node, edges_, r.length, {std::max(one, other), std::min(one, other)}});
      }
    std::erase_if(next, is_irregular);
    front_ = std::move(next);
  }

 private:
  struct Reached {
    int edges = 0, before = -1;
    double length = 0;
    int x = 0, y = 0;   // offset in the grid along the path
    int edge = -1;      // last edge, as the lower of its half-edges
    int direction = 0;  // direction of that step, in right angles
  };
  struct Way {
    int edge, to;
  };

  /// Returns the edges at a node counterclockwise; on the boundary from the first to the last.
  std::vector<Way> ways(int node) const {
    const OpenQuads& quads = charges_->quads();
    const auto edge = [&](int h) { return quads.twin(h) < 0 ? h : std::min(h, quads.twin(h)); };
    std::vector<Way> ways;
    int last = -1;
    quads.for_each_out(node, [&](int h) {
      ways.push_back({edge(h), quads.target(h)});
      last = quads.prev(h);
    });
    if (!quads.inside(node)) ways.push_back({last, quads.origin(last)});
    return ways;
  }

  void leave(int node, std::vector<int>& next) {
    const Reached from = reached_.at(node);
    const std::vector<Way> out = ways(node);
    const auto back = std::ranges::find(out, from.edge, &Way::edge) - out.begin();
    for (int i = 0; i < static_cast<int>(out.size()); ++i) {
      const int to = out[i].to;
      const int direction =
          from.edge < 0 ? i
                        : from.direction + 2 + i - static_cast<int>(back) + 4 * static_cast<int>(out.size());
      Reached r{edges_,       node,   from.length + norm(charges_->at(to) - charges_->at(node)),
                from.x,       from.y, out[i].edge,
                direction % 4};
      (r.direction % 2 == 0 ? r.x : r.y) += r.direction < 2 ? 1 : -1;
      const auto [known, is_new] = reached_.try_emplace(to, r);
      if (is_new) next.push_back(to);
      if (!is_new && known->second.edges == edges_ && key(r) < key(known->second)) known->second = r;
    }
  }
  std::tuple<double, std::tuple<double, double, double>> key(const Reached& r) const {
    return {r.length, key_of(charges_->at(r.before))};
  }

  const Charges* charges_;
  int source_, edges_ = 0;
  std::vector<int> front_;
  std::unordered_map<int, Reached> reached_;
};

}  // namespace

PairedVertices pair_irregular(const Mesh& mesh, std::span<const HalfEdge> sides) {
  const Charges charges(mesh, sides);
  std::vector<int> left = charges.charge();
  // Start at the charges of the rarer sign in a patch: nearly all of them find a partner.
  std::vector<PathSearch> searches;
  for (int node = 0; node < charges.quads().size(); ++node)
    if (left[node] != 0 && (left[node] > 0) == (charges.total(node) <= 0))
      searches.emplace_back(charges, node);

  PairedVertices result;
  result.necessary = charges.necessary();
  result.beyond = charges.beyond();
  while (!searches.empty()) {
    check_cancelled();
    std::vector<Candidate> met;
    for (PathSearch& search : searches) search.step(met);
    std::ranges::sort(met, {}, [&](const Candidate& c) {
      return std::tuple(c.length, key_of(charges.at(c.from)), key_of(charges.at(c.to)));
    });
    for (const Candidate& c : met)
      while (left[c.from] != 0 && left[c.to] != 0) {
        const int sign = left[c.from] > 0 ? 1 : -1;
        left[c.from] -= sign;
        left[c.to] += sign;
        const int few = sign > 0 ? c.from : c.to, many = sign > 0 ? c.to : c.from;
        result.pairs.push_back({charges.point(few), charges.point(many), c.edges, c.burgers});
      }
    std::erase_if(searches, [&](const PathSearch& s) { return s.is_done() || left[s.source()] == 0; });
  }
  for (const int charge : left) result.unpaired += std::abs(charge);
  return result;
}

}  // namespace delquad
