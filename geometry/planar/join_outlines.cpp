// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/planar/join_outlines.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "base/box.h"
#include "base/box_tree.h"
#include "base/disjoint_sets.h"
#include "base/text.h"
#include "geometry/planar/model_chain.h"

namespace delquad {
namespace {

/// A curve with its ends moved a little.
class MovedEnds final : public Curve {
 public:
  MovedEnds(std::shared_ptr<const Curve> base, Vec2 from, Vec2 to)
      : base_(std::move(base)),
        from_(from),
        to_(to),
        d0_(from - base_->point(0)),
        d1_(to - base_->point(1)) {}
  Vec2 point(double t) const override {
    return t <= 0 ? from_ : t >= 1 ? to_ : base_->point(t) + (1 - t) * d0_ + t * d1_;
  }
  std::vector<double> fixed_parameters() const override { return base_->fixed_parameters(); }

 private:
  std::shared_ptr<const Curve> base_;
  Vec2 from_, to_, d0_, d1_;
};

/// An end of a curve: 2 * curve + (0: start, 1: end). It also stands for the path along the curve from there.
using End = int;
End far_end(End e) { return e ^ 1; }

std::vector<Vec2> points_along(const Curve& curve) {
  constexpr int kParts = 64;
  std::vector<double> at = curve.fixed_parameters();
  for (int k = 0; k <= kParts; ++k) at.push_back(k / static_cast<double>(kParts));
  std::ranges::sort(at);
  std::vector<Vec2> points;
  for (const double t : at) points.push_back(curve.point(t));
  return points;
}

class OutlineJoiner {
 public:
  explicit OutlineJoiner(PlanarModel& model) : model_(model), curves_(model.curves) {
    is_free_.assign(curves_.size(), true);
    for (const ModelLoop& loop : model.loops)
      for (const int c : loop.curves) is_free_[c] = false;
    for (std::size_t c = 0; c < curves_.size(); ++c)
      if (curves_[c].is_crack || curves_[c].is_gone) is_free_[c] = false;
    for (const ModelCurve& curve : curves_)
      for (const double t : {0., 1.}) ends_.push_back(curve.shape->point(t));
  }

  std::string run() {
    join_ends();
    drop_copies();
    const std::string loose = drop_loose();
    std::vector<int> closed;
    for (int c = 0; c < static_cast<int>(curves_.size()); ++c)
      if (is_free_[c]) closed.push_back(c);
    for (const std::vector<int>& group : connected_groups(closed)) {
      const bool is_even =
          std::ranges::all_of(group, [&](int c) { return n_at(2 * c) % 2 == 0 && n_at(2 * c + 1) % 2 == 0; });
      for (const std::vector<int>& loop : connected_groups(is_even ? group : outer_of(group)))
        model_.loops.push_back({loop, "", curves_[loop[0]].where});
    }
    return loose;
  }

 private:
  std::size_t n_at(End e) const { return at_node_.at(node_[e]).size(); }

  std::vector<std::vector<int>> connected_groups(const std::vector<int>& curves) const {
    DisjointSets nodes(ends_.size());
    for (const int c : curves) nodes.join(node_[2 * c], node_[2 * c + 1]);
    std::map<int, std::vector<int>> groups;
    for (const int c : curves) groups[nodes.root(node_[2 * c])].push_back(c);
    std::vector<std::vector<int>> result;
    for (auto& [root, group] : groups) result.push_back(std::move(group));
    std::ranges::sort(result);
    return result;
  }

  void join_ends() {
    const double gap = gap_ = kCoincidence * norm(Box<Vec2>::around(std::span<const Vec2>(ends_)).size());
    std::vector<End> order;
    for (End e = 0; e < static_cast<End>(ends_.size()); ++e)
      if (is_free_[e / 2]) order.push_back(e);
    std::ranges::sort(order, {}, [&](End e) { return std::pair{ends_[e].x, e}; });
    DisjointSets nodes(ends_.size());
    for (std::size_t i = 0; i < order.size(); ++i)
      for (std::size_t j = i + 1; j < order.size() && ends_[order[j]].x - ends_[order[i]].x <= gap; ++j)
        if (norm(ends_[order[j]] - ends_[order[i]]) <= gap) nodes.join(order[i], order[j]);
    node_ = nodes.roots();
    for (const End e : order) at_node_[node_[e]].push_back(e);
    for (std::size_t c = 0; c < curves_.size(); ++c) {
      const Vec2 from = ends_[node_[2 * c]], to = ends_[node_[2 * c + 1]];
      if (from != ends_[2 * c] || to != ends_[2 * c + 1])
        curves_[c].shape = std::make_shared<MovedEnds>(curves_[c].shape, from, to);
    }
  }

  /// Keeps one of several equal curves.
  void drop_copies() {
    std::map<std::pair<int, int>, std::vector<int>> by_ends;
    for (int c = 0; c < static_cast<int>(curves_.size()); ++c) {
      if (!is_free_[c]) continue;
      std::vector<int>& known = by_ends[std::minmax(node_[2 * c], node_[2 * c + 1])];
      const auto at = [&](int curve, double t) {
        return curves_[curve].shape->point(node_[2 * curve] == node_[2 * c] ? t : 1 - t);
      };
      const bool is_copy = std::ranges::any_of(known, [&](int other) {
        return std::ranges::all_of(std::array{0.25, 0.5},
                                   [&](double t) { return norm(at(other, t) - at(c, t)) <= gap_; });
      });
      if (!is_copy) {
        known.push_back(c);
        continue;
      }
      is_free_[c] = false;
      curves_[c].is_gone = true;
      for (const End e : {2 * c, 2 * c + 1}) std::erase(at_node_[node_[e]], e);
    }
  }

  /// Removes curves with a loose end, again and again. Returns the place of a loose end, for messages.
  std::string drop_loose() {
    std::vector<int> lone;
    for (const auto& [v, at] : at_node_)
      if (at.size() == 1) lone.push_back(v);
    const std::vector<int> first = lone;
    while (!lone.empty()) {
      const int v = lone.back();
      lone.pop_back();
      if (at_node_[v].size() != 1) continue;
      const End e = at_node_[v][0];
      is_free_[e / 2] = false;
      at_node_[v].clear();
      std::vector<End>& there = at_node_[node_[far_end(e)]];
      std::erase(there, far_end(e));
      if (there.size() == 1) lone.push_back(node_[far_end(e)]);
    }
    if (first.size() < 2) return "";
    const Vec2 x = ends_[first[0]];
    const int next = *std::ranges::min_element(first.begin() + 1, first.end(), {},
                                               [&](int v) { return norm(ends_[v] - x); });
    return fmt::format("{} ends at {}, and {}, whose end is next, {:.3g} from there",
                       curve_label(model_, first[0] / 2), show_point(x), curve_label(model_, next / 2),
                       norm(ends_[next] - x));
  }

  /// Returns points along a curve from one end, without the other end.
  std::vector<Vec2> points_from(End e) const {
    std::vector<Vec2> points = points_along(*curves_[e / 2].shape);
    if (e % 2 == 1) std::ranges::reverse(points);
    points.pop_back();
    return points;
  }

  double angle_at(End e) const {
    constexpr double kStep = 1e-6;
    const Vec2 d = curves_[e / 2].shape->point(e % 2 == 0 ? kStep : 1 - kStep) - ends_[node_[e]];
    return std::atan2(d.y, d.x);
  }

  /// Returns the outer outline of connected curves: it alone is clockwise if faces lie on the left.
  std::vector<int> outer_of(const std::vector<int>& group) {
    std::set<int> nodes;
    for (const int c : group) nodes.insert({node_[2 * c], node_[2 * c + 1]});
    std::map<End, End> next;  // path that follows a path
    for (const int v : nodes) {
      std::vector<End>& at = at_node_[v];
      std::ranges::sort(at, {}, [&](End end) { return std::pair(angle_at(end), end); });
      for (std::size_t i = 0; i < at.size(); ++i) next[far_end(at[(i + 1) % at.size()])] = at[i];
    }
    std::vector<int> outer;
    double least = 0;
    while (!next.empty()) {
      std::vector<int> cycle;
      std::vector<Vec2> points;
      for (auto at = next.begin(); at != next.end();) {
        const auto [e, to] = *at;
        cycle.push_back(e / 2);
        for (const Vec2 p : points_from(e)) points.push_back(p);
        next.erase(at);
        at = next.find(to);
      }
      double area = 0;
      for (std::size_t i = 1; i + 1 < points.size(); ++i)
        area += cross(points[i] - points[0], points[i + 1] - points[0]);
      if (area < least) least = area, outer = cycle;
    }
    std::ranges::sort(outer);
    // Curves with the outer face on both sides are no outlines.
    std::erase_if(outer, [&, all = outer](int c) { return std::ranges::equal_range(all, c).size() > 1; });
    return outer;
  }

  PlanarModel& model_;
  std::vector<ModelCurve>& curves_;
  std::vector<char> is_free_;  ///< whether each curve may be part of a loop
  std::vector<Vec2> ends_;
  double gap_ = 0;
  std::vector<int> node_;                    ///< node of each end
  std::map<int, std::vector<End>> at_node_;  ///< the ends of free curves
};

/// Removes the curves that are gone, and renumbers the others.
void drop_gone(PlanarModel& model) {
  std::vector<int> number;
  int n = 0;
  for (const ModelCurve& curve : model.curves) number.push_back(curve.is_gone ? -1 : n++);
  for (ModelLoop& loop : model.loops)
    for (int& c : loop.curves) c = number[c];
  std::erase_if(model.curves, [](const ModelCurve& curve) { return curve.is_gone; });
}

}  // namespace

std::string join_outlines(PlanarModel& model) {
  if (model.curves.empty()) return "";
  const std::string loose = OutlineJoiner(model).run();
  drop_gone(model);
  return loose;
}

int leave_out_outside(PlanarModel& model) {
  std::vector<char> has_loop(model.curves.size(), 0);
  std::vector<std::array<Vec2, 2>> sides;
  std::vector<Box<Vec2>> boxes;
  double right = 0;
  for (const ModelLoop& loop : model.loops)
    for (const int c : loop.curves) {
      has_loop[c] = 1;
      const std::vector<Vec2> points = points_along(*model.curves[c].shape);
      for (std::size_t i = 1; i < points.size(); ++i) {
        sides.push_back({points[i - 1], points[i]});
        boxes.push_back(Box<Vec2>::around(sides.back()));
        right = std::max(right, boxes.back().high.x);
      }
    }
  const BoxTree<Vec2> tree(boxes);
  const auto is_outside = [&](Vec2 x) {  // a ray to the right meets an even number of sides
    int met = 0;
    tree.overlapping({x, {std::max(x.x, right), x.y}}, [&](int s) {
      const auto& [a, b] = sides[s];
      if ((a.y > x.y) != (b.y > x.y)) met += a.x + (x.y - a.y) / (b.y - a.y) * (b.x - a.x) > x.x;
    });
    return met % 2 == 0;
  };
  int gone =
      static_cast<int>(std::erase_if(model.points, [&](const ModelPoint& p) { return is_outside(p.at); }));
  for (std::size_t c = 0; c < model.curves.size(); ++c) {
    const Curve& shape = *model.curves[c].shape;
    if (has_loop[c] || !std::ranges::all_of(std::array{0.03, 0.27, 0.5, 0.73, 0.97},
                                            [&](double t) { return is_outside(shape.point(t)); }))
      continue;
    model.curves[c].is_gone = true;
    ++gone;
  }
  drop_gone(model);
  return gone;
}

}  // namespace delquad
