// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/patches/narrow_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "base/disjoint_sets.h"
#include "geometry/mesh/constrained_delaunay.h"
#include "geometry/patches/face_corners.h"
#include "geometry/planar/check_lines.h"

namespace delquad {

namespace {

/// Distance between places of looks, over the size.
constexpr double kSpacing = 0.25;
constexpr int kMostPlaces = 400;  // limit on a fine line
/// Least part of their lengths along which both curves of a strip face each other, and largest ratio of their
/// lengths.
constexpr double kStripPart = 0.7, kStripRatio = 1.6;

/// A place with a near boundary on the other side.
struct Gap {
  int patch;
  int chain, facing;  ///< curves on this side and on the other
  double length;      ///< length of the piece of boundary that it represents
};

/// Returns the gaps across from places along all curves.
std::vector<Gap> collect_gaps(const Mesh& fine, const std::vector<CurveChain>& chains,
                              const AcrossView& across, const SizeOnLine& size) {
  std::vector<Gap> gaps;
  int hint = -1;
  for (size_t c = 0; c < chains.size(); ++c)
    for (size_t line = 0; line + 1 < chains[c].points.size(); ++line) {
      const int first = chains[c].points[line], last = chains[c].points[line + 1];
      const Vec3 a = fine.points[first], d = fine.points[last] - a;
      const double length = norm(d);
      const auto size_at = [&](double t) { return size(first, last, t, a + t * d, hint); };
      const double spacing = kSpacing * std::min({size_at(0), size_at(1), size_at(0.5)});
      const int n = static_cast<int>(std::clamp(std::ceil(length / spacing), 1.0, double(kMostPlaces)));
      for (int i = 0; i < n; ++i) {
        const double t = (i + 0.5) / n;
        for (const Opposite& o :
             across.look(static_cast<int>(c), static_cast<double>(line) + t, kReach * size_at(t)))
          gaps.push_back({o.patch, static_cast<int>(c), o.chain, length / n});
      }
    }
  return gaps;
}

double length_of(const Mesh& fine, const CurveChain& chain) {
  double sum = 0;
  for (size_t i = 0; i + 1 < chain.points.size(); ++i)
    sum += norm(fine.points[chain.points[i + 1]] - fine.points[chain.points[i]]);
  return sum;
}

}  // namespace

std::vector<int> group_facing_curves(const Mesh& fine, const std::vector<CurveChain>& chains,
                                     const AcrossView& across, const SizeOnLine& size) {
  const std::vector<Gap> gaps = collect_gaps(fine, chains, across, size);
  std::map<std::array<int, 3>, double> along;  // patch, curve, and facing curve
  for (const Gap& g : gaps) along[{g.patch, g.chain, g.facing}] += g.length;
  DisjointSets groups(chains.size());
  for (const auto& [key, length] : along) {
    const auto [patch, a, b] = key;
    const auto back = along.find({patch, b, a});
    if (a >= b || back == along.end()) continue;
    const double length_a = length_of(fine, chains[a]), length_b = length_of(fine, chains[b]);
    if (length < kStripPart * length_a || back->second < kStripPart * length_b ||
        std::max(length_a, length_b) > kStripRatio * std::min(length_a, length_b))
      continue;
    groups.join(a, b);
  }
  return groups.roots();
}

namespace {

/// Largest distance of opposite nodes, in edges, and least sine between their line and the boundary on one
/// side.
constexpr double kWidest = 1.1, kAcross = 0.6;

double sine(Vec2 a, Vec2 b) { return std::abs(cross(a, b)) / (norm(a) * norm(b)); }

class NarrowSeeds {
 public:
  NarrowSeeds(PatchBoundary& boundary, double least) : boundary_(boundary), least_(least) {
    const size_t n = boundary.points.size();
    next_.resize(n), previous_.resize(n), loop_.resize(n), place_.resize(n);
    for (const auto& [a, b] : boundary.edges) next_[a] = b, previous_[b] = a;
    for (const auto& edges : loops_of_edges(boundary)) {
      auto& points = loops_.emplace_back();
      for (const int e : edges) {
        const int v = boundary.edges[e][0];
        loop_[v] = static_cast<int>(loops_.size()) - 1;
        place_[v] = static_cast<int>(points.size());
        points.push_back(v);
      }
    }
  }

  void run() {
    std::vector<char> used(boundary_.points.size(), 0);
    for (const auto& [length, a, b] : rungs()) {
      if (used[a] || used[b]) continue;
      used[a] = used[b] = 1;
      if (length >= least_ * edge_at(a, b) && cuts_off_odd(a, b))
        boundary_.seeds.push_back(0.5 * (at(a) + at(b)));
    }
  }

 private:
  using Rung = std::tuple<double, int, int>;  ///< length, ends

  Vec2 at(int v) const { return boundary_.points[v]; }

  /// Returns the edges of the Delaunay triangulation between opposite nodes of one loop, the shortest first.
  std::vector<Rung> rungs() const {
    const TriPatch tri = constrained_delaunay(boundary_);
    std::vector<Rung> found;
    for (size_t t = 0; t < tri.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        if (tri.neighbours[t][k] <= static_cast<int>(t)) continue;
        const auto [a, b] = std::minmax({tri.triangles[t][(k + 1) % 3], tri.triangles[t][(k + 2) % 3]});
        if (loop_[a] == loop_[b] && opposite(a, b)) found.emplace_back(norm(at(b) - at(a)), a, b);
      }
    std::sort(found.begin(), found.end());
    return found;
  }

  /// Returns the mean length of the edges at both nodes.
  double edge_at(int a, int b) const {
    double sum = 0;
    for (const int v : {a, b})
      for (const int w : {next_[v], previous_[v]}) sum += norm(at(w) - at(v));
    return sum / 4;
  }

  bool opposite(int a, int b) const {
    const Vec2 across = at(b) - at(a);
    const Vec2 a_on = at(next_[a]) - at(a), a_back = at(previous_[a]) - at(a);
    const Vec2 b_on = at(next_[b]) - at(b), b_back = at(previous_[b]) - at(b);
    if (norm(across) > kWidest * edge_at(a, b)) return false;
    if (next_[next_[a]] == b && !sharp(next_[a])) return false;
    if (next_[next_[b]] == a && !sharp(next_[b])) return false;
    return std::min(sine(a_on, across), sine(b_back, across)) > kAcross ||
           std::min(sine(a_back, across), sine(b_on, across)) > kAcross;
  }

  bool sharp(int v) const {
    const Vec2 on = at(next_[v]) - at(v), back = at(previous_[v]) - at(v);
    return cross(on, back) > 0 && std::atan2(cross(on, back), dot(on, back)) < kOneQuadAngle;
  }

  /// Returns whether the boundary on the left of the line from b to a, and this line, have an odd number of
  /// edges.
  bool cuts_off_odd(int a, int b) const {
    const int n = static_cast<int>(loops_[loop_[a]].size());
    int edges = 1 + (place_[b] - place_[a] + n) % n;
    std::vector<Vec2> outline;  // set if other loops may lie inside
    for (const auto& loop : loops_) {
      if (loop_[loop[0]] == loop_[a] || loop.size() % 2 == 0) continue;
      for (int v = outline.empty() ? a : b; v != b; v = next_[v]) outline.push_back(at(v));
      if (outline.back() != at(b)) outline.push_back(at(b));
      if (contains(outline, at(loop[0]))) ++edges;
    }
    return edges % 2 == 1;
  }

  /// Returns whether x is inside, by the even-odd rule.
  static bool contains(const std::vector<Vec2>& polygon, Vec2 x) {
    bool inside = false;
    for (size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
      const Vec2 p = polygon[i], q = polygon[j];
      if ((p.y > x.y) != (q.y > x.y) && x.x < p.x + (x.y - p.y) / (q.y - p.y) * (q.x - p.x)) inside = !inside;
    }
    return inside;
  }

  PatchBoundary& boundary_;
  const double least_;
  std::vector<int> next_, previous_, loop_;
  std::vector<int> place_;  ///< place in its loop
  std::vector<std::vector<int>> loops_;
};

}  // namespace

void seed_narrow_places(PatchBoundary& boundary, double least) { NarrowSeeds(boundary, least).run(); }

}  // namespace delquad
