// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/layers/layer_columns.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/box_tree.h"
#include "base/cancel.h"
#include "base/predicates.h"
#include "base/text.h"
#include "delquad/error.h"

namespace delquad {
namespace {

/// By which layers are lower in the next round, and how many rounds there are: down to 1e-7.
constexpr double kLower = 0.9;
constexpr int kMostRounds = 150;
/// How much thickness may change along a curve, by length.
constexpr double kSteepest = 0.3;
/// The least part of an edge's length that is left of it at the front.
constexpr double kLeastFront = 0.4;
/// How far layers keep from others, by their thickness and by the edges at their feet.
constexpr double kGap = 0.5;

/// A segment that fronts must not touch.
struct Segment {
  Vec2 a, b;
  std::array<int, 2> points;              ///< of the patch, to which it belongs: columns of a point may touch
  std::array<int, 2> walls = {-1, -1};    ///< on which its points lie
  std::array<int, 2> free_of = {-1, -1};  ///< at whose ends these stand free
  bool is_of_layer = true;
};

bool share(const std::array<int, 2>& a, const std::array<int, 2>& b) {
  const auto has = [&](int i) { return i >= 0 && (i == b[0] || i == b[1]); };
  return has(a[0]) || has(a[1]);
}

bool touch(const Segment& s, const Segment& t) {
  return orient2d(s.a, s.b, t.a) * orient2d(s.a, s.b, t.b) <= 0 &&
         orient2d(t.a, t.b, s.a) * orient2d(t.a, t.b, s.b) <= 0;
}

Box<Vec2> box_of(const Segment& s) { return {lower(s.a, s.b), upper(s.a, s.b)}; }

bool overlap(const Box<Vec2>& a, const Box<Vec2>& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y;
}

class LayerFitter {
 public:
  LayerFitter(const PlanarDomain& domain, int patch, std::span<const LayerSpec> specs, LayerColumns& layers)
      : domain_(domain), patch_(domain.patches[patch]), specs_(specs), layers_(layers) {
    add_boundary();
  }

  void fit(bool again) {
    if (layers_.n_chains() == 0) return;
    for (int round = 0; round < kMostRounds; ++round) {
      check_cancelled();
      limit_slopes();
      if (!again || round > 0) cut_peaks();
      layers_.place();
      too_high_.assign(patch_.points.size(), 0);
      for (int c = 0; c < layers_.n_chains(); ++c) check_quads(c);
      check_distances();
      if (std::ranges::find(too_high_, 1) == too_high_.end()) check_ends();
      if (!lower_marked()) return;
    }
    refuse();
  }

 private:
  void add_boundary() {
    std::vector<int> wall(patch_.points.size(), -1);  // of the edge from a point
    const auto& walls = layers_.found().walls;
    for (std::size_t w = 0; w < walls.size(); ++w)
      for (std::size_t i = 0; i + 1 < walls[w].points.size(); ++i)
        wall[walls[w].points[i]] = static_cast<int>(w);
    for (const auto& [a, b] : patch_.edges)
      boundary_.push_back({patch_.points[a], patch_.points[b], {a, b}, {wall[a], -1}, {-1, -1}, false});
  }

  /// No thickness differs from its neighbors' by more than kSteepest; the lower one counts.
  void limit_slopes() {
    for (int c = 0; c < layers_.n_chains(); ++c) {
      const int n = layers_.chain(c).n_points();
      // `edge`: the point at which that between both begins.
      const auto limit = [&](int from, int to, int edge) {
        const int top = layers_.layers_on(c, edge);
        const double most = layers_.height(c, from, top) + kSteepest * layers_.distance(c, from, to);
        if (const double h = layers_.height(c, to, top); h > most) layers_.scales[c][to] *= most / h;
      };
      const bool is_closed = layers_.chain(c).is_closed;
      for (int k = 1; k < (is_closed ? 2 * n : n); ++k) limit((k - 1) % n, k % n, (k - 1) % n);
      for (int k = is_closed ? 2 * n - 1 : n - 1; k > 0; --k) limit(k % n, (k - 1) % n, (k - 1) % n);
    }
  }

  /// No scale is above the mean of its neighbors'. Rounds of this blur the steps of the others.
  void cut_peaks() {
    for (int c = 0; c < layers_.n_chains(); ++c) {
      const std::vector<double> old = layers_.scales[c];
      const int n = static_cast<int>(old.size()), margin = layers_.chain(c).is_closed ? 0 : 1;
      for (int k = margin; k < n - margin; ++k)
        layers_.scales[c][k] = std::min(old[k], (old[(k + n - 1) % n] + old[(k + 1) % n]) / 2);
    }
  }

  void mark(int c, const LayerColumn& column) { too_high_[layers_.chain(c).points[column.at]] = 1; }

  void check_quads(int c) {
    const auto& columns = layers_.columns(c);
    layers_.for_each_pair(c, [&](int a, int b) {
      if (columns[a].point == columns[b].point) return;
      const Vec2 edge = layers_.foot(c, columns[b].at) - layers_.foot(c, columns[a].at);
      const int top = layers_.layers_between(c, a, b);
      const Vec2 front = layers_.node(c, {b, top}) - layers_.node(c, {a, top});
      if (dot(front, edge) < kLeastFront * dot(edge, edge)) mark(c, columns[a]), mark(c, columns[b]);
    });
    layers_.for_each_quad(c, [&](const std::array<ColumnNode, 4>& quad) {
      std::array<Vec2, 4> p;
      for (int i = 0; i < 4; ++i) p[i] = layers_.node(c, quad[i]);
      for (int i = 0; i < 4; ++i)
        if (orient2d(p[i], p[(i + 1) % 4], p[(i + 2) % 4]) <= 0)
          for (const ColumnNode& node : quad) mark(c, columns[node.column]);
    });
  }

  /// Sides that lie on walls fit these.
  void check_ends() {
    for (int c = 0; c < layers_.n_chains(); ++c)
      for (const LayerColumn& column : layers_.columns(c))
        if (column.wall >= 0 &&
            column.slant * layers_.thickness(c, column.at) > layers_.found().walls[column.wall].room())
          mark(c, column);
  }

  /// A node of a column, and the distance that it keeps.
  Vec2 guarded(int c, const LayerColumn& column, int layer) const {
    const double h = layers_.height(c, column.at, layer);
    const auto [before, after] = layers_.edges_at(c, column.at);
    return layers_.point(c, column, h + kGap * std::min({h, before, after}));
  }

  int free_of(int c, const LayerColumn& column) const {
    const bool is_free = layers_.corner(c, column.at).kind == ChainCorner::kOpenEnd;
    return is_free ? layers_.chain(c).wall[column.at == 0 ? 0 : 1] : -1;
  }

  std::vector<Segment> segments() const {
    std::vector<Segment> all = boundary_;
    for (int c = 0; c < layers_.n_chains(); ++c) {
      const auto& columns = layers_.columns(c);
      for (const LayerColumn& column : columns)
        all.push_back({layers_.foot(c, column.at),
                       guarded(c, column, layers_.layers_at(c, column.at)),
                       {column.point, -1},
                       {column.wall, -1},
                       {free_of(c, column), -1}});
      layers_.for_each_pair(c, [&](int a, int b) {
        const int top = layers_.layers_between(c, a, b);
        all.push_back({guarded(c, columns[a], top),
                       guarded(c, columns[b], top),
                       {columns[a].point, columns[b].point},
                       {columns[a].wall, columns[b].wall},
                       {free_of(c, columns[a]), free_of(c, columns[b])}});
      });
    }
    return all;
  }

  void check_distances() {
    const std::vector<Segment> all = segments();
    std::vector<Box<Vec2>> boxes;
    for (const Segment& s : all) boxes.push_back(box_of(s));
    const BoxTree<Vec2> tree(boxes);
    for (std::size_t i = boundary_.size(); i < all.size(); ++i)
      tree.search(
          0.0, [&](const auto& node) { return overlap(node.box, boxes[i]) ? 0.0 : 1.0; },
          [&](int j) { compare(all[i], all[j]); });
  }

  /// Where layers on a wall reach those that stand free at its other end, these stay as they are.
  void compare(const Segment& s, const Segment& t) {
    if (share(s.points, t.points) || share(s.walls, t.walls) || !overlap(box_of(s), box_of(t)) ||
        !touch(s, t))
      return;
    const bool stays_s = t.is_of_layer && share(s.free_of, t.walls), stays_t = share(t.free_of, s.walls);
    const auto mark = [&](const Segment& one, bool stays) {
      for (const int p : one.points)
        if (one.is_of_layer && !stays && p >= 0) too_high_[p] = 1;
    };
    mark(s, stays_s && !stays_t);
    mark(t, stays_t && !stays_s);
  }

  bool lower_marked() {
    bool some = false;
    for (int c = 0; c < layers_.n_chains(); ++c)
      for (int k = 0; k < layers_.chain(c).n_points(); ++k) {
        if (!too_high_[layers_.chain(c).points[k]]) continue;
        some = true;
        layers_.scales[c][k] *= kLower;
      }
    return some;
  }

  [[noreturn]] void refuse() const {
    const int p = static_cast<int>(std::ranges::find(too_high_, 1) - too_high_.begin());
    const auto& chains = layers_.found().chains;
    const auto chain = std::ranges::find_if(
        chains, [&](const LayerChain& c) { return std::ranges::find(c.points, p) != c.points.end(); });
    const auto k = static_cast<std::size_t>(std::ranges::find(chain->points, p) - chain->points.begin());
    const LayerSpec& spec = specs_[chain->spec[std::min(k, chain->spec.size() - 1)]];
    throw InputError(fmt::format("{}: there is no place for the layer on '{}' at {} [no-place-for-layers]",
                                 spec.where, fmt::join(spec.on, "', '"),
                                 show_node(domain_, patch_.point_node[p])));
  }

  const PlanarDomain& domain_;
  const PatchBoundary& patch_;
  std::span<const LayerSpec> specs_;
  LayerColumns& layers_;
  std::vector<Segment> boundary_;
  std::vector<char> too_high_;  ///< by point of the patch
};

}  // namespace

void fit_layers(const PlanarDomain& domain, int patch, std::span<const LayerSpec> specs, LayerColumns& layers,
                bool again) {
  LayerFitter(domain, patch, specs, layers).fit(again);
}

}  // namespace delquad
