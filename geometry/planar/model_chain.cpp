// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/planar/model_chain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "base/box_tree.h"
#include "delquad/error.h"
#include "geometry/planar/curve_span.h"
#include "geometry/planar/point_grid.h"

namespace delquad {

namespace {

/// One end of a curve: 2 * curve + (0: start, 1: end).
using End = int;

std::string prefix(const std::string& where) { return where.empty() ? "" : where + ": "; }

std::string loop_label(const PlanarModel& model, int loop) {
  const ModelLoop& l = model.loops[static_cast<std::size_t>(loop)];
  return l.where.empty() ? fmt::format("loop {}", loop + 1) : fmt::format("the loop of {}", l.where);
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A few points of each curve, to find the model's extent and curves without length. Their number of parts is
// prime, so that no periodic formula hides.
struct Outline {
  Box<Vec2> extent{{kInfinity, kInfinity}, {-kInfinity, -kInfinity}};
  std::vector<double> lengths;

  explicit Outline(const PlanarModel& model) {
    constexpr int kParts = 17;
    for (std::size_t c = 0; c < model.curves.size(); ++c) {
      const Curve& shape = *model.curves[c].shape;
      std::vector<double> parameters = shape.fixed_parameters();
      for (int k = 0; k <= kParts; ++k) parameters.push_back(k / static_cast<double>(kParts));
      std::ranges::sort(parameters);
      double length = 0;
      Vec2 last = shape.point(0);
      for (double t : parameters) {
        const Vec2 p = shape.point(t);
        if (!std::isfinite(p.x) || !std::isfinite(p.y))
          throw InputError(fmt::format("{}{} is ({}, {}) at {} of its way: expected finite coordinates",
                                       prefix(model.source), curve_label(model, static_cast<int>(c)), p.x,
                                       p.y, t));
        length += norm(p - last);
        extent.add(p);
        last = p;
      }
      lengths.push_back(length);
    }
  }
};

class Chainer {
 public:
  explicit Chainer(const PlanarModel& model) : model_(model) {
    const Outline outline(model);
    low_ = outline.extent.low;
    tolerance_ = kJoinTolerance * norm(outline.extent.size());
    for (std::size_t c = 0; c < model.curves.size(); ++c) {
      if (!(outline.lengths[c] > tolerance_)) {
        const Vec2 p = model.curves[c].shape->point(0);
        throw InputError(fmt::format("{}{} has no length: it stays at ({}, {})", prefix(model.source),
                                     curve_label(model, static_cast<int>(c)), p.x, p.y));
      }
      ends_.push_back(model.curves[c].shape->point(0));
      ends_.push_back(model.curves[c].shape->point(1));
    }
    grid_.emplace(low_, tolerance_);
  }

  ModelChain run() {
    chain_.loops = merge_loops();
    chain_.curve_ends.resize(model_.curves.size());
    for (std::size_t e = 0; e < ends_.size(); ++e) chain_.curve_ends[e / 2][e % 2] = node_at(ends_[e]);
    for (const ModelLoop& loop : chain_.loops) check_closed(loop);
    add_corners();
    for (const ModelPoint& point : model_.points) chain_.point_nodes.push_back(node_at(point.at));
    join_spans();
    return std::move(chain_);
  }

 private:
  /// Returns whether no loop has the curve.
  bool is_embedded(int curve) const { return std::ranges::binary_search(embedded_, curve); }

  /// Returns the node at x, and makes one if there is none.
  int node_at(Vec2 x) {
    const int known = grid_->find(x, chain_.nodes);
    if (known >= 0) return known;
    grid_->add(x, static_cast<int>(chain_.nodes.size()));
    chain_.nodes.push_back(x);
    return static_cast<int>(chain_.nodes.size()) - 1;
  }

  void add_corners() {
    for (const ModelCurve& curve : model_.curves) {
      std::vector<CurveStop>& stops = chain_.stops.emplace_back();
      for (const double t : curve.shape->fixed_parameters())
        stops.push_back({t, node_at(curve.shape->point(t))});
    }
  }

  /// A span between two stops.
  struct Span {
    int curve;
    std::array<int, 2> ends;
    CurveSpan shape;
  };

  void join_spans() {
    std::vector<Span> spans;
    std::vector<Box<Vec2>> boxes;
    for (int c = 0; c < static_cast<int>(model_.curves.size()); ++c) {
      if (model_.curves[c].is_gone) continue;
      double t = 0;
      int node = chain_.curve_ends[c][0];
      std::vector<CurveStop> stops = chain_.stops[c];
      stops.push_back({1, chain_.curve_ends[c][1]});
      for (const CurveStop& stop : stops) {
        spans.push_back({c, {node, stop.node}, CurveSpan(*model_.curves[c].shape, t, stop.t)});
        boxes.push_back(spans.back().shape.box().grown(tolerance_));
        t = stop.t;
        node = stop.node;
      }
    }
    const BoxTree<Vec2> tree(boxes);
    const auto near = [&](const Box<Vec2>& box, const auto& visit) {
      tree.overlapping(box, [&](int i) {
        if (boxes[i].overlaps(box)) visit(spans[i]);
      });
    };
    for (int v = 0, n = static_cast<int>(chain_.nodes.size()); v < n; ++v)
      near({chain_.nodes[v], chain_.nodes[v]}, [&](const Span& span) { stop_at(span, v); });
    for (std::size_t i = 0; i < spans.size(); ++i)
      if (is_embedded(spans[i].curve))
        near(boxes[i], [&](const Span& other) {
          if (&other != &spans[i] && (&other > &spans[i] || !is_embedded(other.curve)))
            cross(spans[i], other);
        });
    for (auto& stops : chain_.stops) std::ranges::sort(stops, {}, &CurveStop::t);
  }

  /// Adds a stop if the node lies on the span, but is none of its ends.
  void stop_at(const Span& span, int node) {
    if (node == span.ends[0] || node == span.ends[1]) return;
    const CurveSpan::Place place = span.shape.nearest(chain_.nodes[node]);
    if (place.distance <= tolerance_) add_stop(span.curve, place.t, node);
  }

  void cross(const Span& span, const Span& other) {
    for (const auto& crossing : span.shape.crossings(other.shape)) {
      const int node = node_at(crossing.at);
      for (const auto& [s, t] : {std::pair(&span, crossing.mine), std::pair(&other, crossing.other)})
        if (node != s->ends[0] && node != s->ends[1]) add_stop(s->curve, t, node);
    }
  }

  void add_stop(int curve, double t, int node) {
    auto& stops = chain_.stops[curve];
    if (std::ranges::find(stops, node, &CurveStop::node) == stops.end()) stops.push_back({t, node});
  }

  std::string label(End e) const { return curve_label(model_, e / 2); }
  Vec2 at(End e) const { return ends_[static_cast<std::size_t>(e)]; }

  // Returns the loops, where a hole and its filling by the same curves become one.
  std::vector<ModelLoop> merge_loops() {
    std::vector<ModelLoop> merged;
    std::vector<int> first_index;
    std::map<std::vector<int>, std::size_t> known;  // by curves, ascending
    std::vector<char> has_loop(model_.curves.size(), 0);
    for (std::size_t l = 0; l < model_.loops.size(); ++l) {
      const ModelLoop& loop = model_.loops[l];
      check_curves(loop, static_cast<int>(l));
      for (const int c : loop.curves) has_loop[c] = 1;
      std::vector<int> curves = loop.curves;
      std::ranges::sort(curves);
      const auto [at, is_new] = known.try_emplace(curves, merged.size());
      if (is_new) {
        merged.push_back(loop);
        first_index.push_back(static_cast<int>(l));
        continue;
      }
      ModelLoop& twin = merged[at->second];
      if (twin.region.empty() == loop.region.empty())
        throw InputError(fmt::format(
            "{}{} and {} consist of the same curves: one of them is too many [overlapping-regions]",
            prefix(model_.source), loop_label(model_, first_index[at->second]),
            loop_label(model_, static_cast<int>(l))));
      if (twin.region.empty()) twin.region = loop.region;
    }
    for (std::size_t c = 0; c < has_loop.size(); ++c)
      if (!has_loop[c]) embedded_.push_back(static_cast<int>(c));
    return merged;
  }

  void check_curves(const ModelLoop& loop, int index) const {
    if (loop.curves.empty())
      throw InputError(fmt::format("{}{} has no curves", prefix(model_.source), loop_label(model_, index)));
    std::vector<int> sorted = loop.curves;
    std::ranges::sort(sorted);
    if (sorted.front() < 0 || sorted.back() >= static_cast<int>(model_.curves.size()))
      throw InputError(fmt::format("{}{} refers to a curve that does not exist; there are {}",
                                   prefix(model_.source), loop_label(model_, index), model_.curves.size()));
    const auto twice = std::ranges::adjacent_find(sorted);
    if (twice != sorted.end())
      throw InputError(fmt::format("{}{} lists {} twice", prefix(model_.source), loop_label(model_, index),
                                   curve_label(model_, *twice)));
  }

  /// Throws InputError unless the loop is connected and an even number of its curves ends at each node.
  void check_closed(const ModelLoop& loop) const {
    const std::string where = prefix(loop.where.empty() ? model_.source : loop.where);
    std::vector<End> ends, loose;
    for (const int c : loop.curves) ends.insert(ends.end(), {2 * c, 2 * c + 1});
    const auto node = [&](End e) { return chain_.curve_ends[e / 2][e % 2]; };
    std::map<int, std::vector<End>> meeting;
    for (const End e : ends) meeting[node(e)].push_back(e);
    for (const End e : ends) {
      const std::vector<End>& here = meeting[node(e)];
      if (here.size() == 1) loose.push_back(e);
      if (here.size() > 1 && here.size() % 2 == 1)
        throw InputError(fmt::format(
            "{}{} ends of curves meet at ({}, {}): of {}, {} and {}: expected two for each loop, one that "
            "arrives and one that leaves",
            where, here.size(), at(e).x, at(e).y, label(here[0]), label(here[1]), label(here[2])));
    }
    if (!loose.empty()) report_open(loose, where);
    std::set<int> walked{loop.curves[0]};
    for (std::vector<int> open{loop.curves[0]}; !open.empty();) {
      const int c = open.back();
      open.pop_back();
      for (const int v : chain_.curve_ends[c])
        for (const End e : meeting[v])
          if (walked.insert(e / 2).second) open.push_back(e / 2);
    }
    if (walked.size() != loop.curves.size())
      throw InputError(
          fmt::format("{}the curves of the loop form several closed chains, and {} of {} are in the chain of "
                      "{}: expected a loop for each chain",
                      where, walked.size(), loop.curves.size(), label(ends[0])));
  }

  // Throws InputError for an open loop. Its odd nodes are at least two, since all others are even.
  [[noreturn]] void report_open(const std::vector<End>& loose, const std::string& where) const {
    const End e = loose[0];
    const End nearest = *std::min_element(loose.begin() + 1, loose.end(), [&](End a, End b) {
      return norm(at(a) - at(e)) < norm(at(b) - at(e));
    });
    throw InputError(
        fmt::format("{}the loop is open between ({}, {}), an end of {}, and ({}, {}) of {} [open-outline]",
                    where, at(e).x, at(e).y, label(e), at(nearest).x, at(nearest).y, label(nearest)));
  }

  const PlanarModel& model_;
  std::vector<Vec2> ends_;
  std::vector<int> embedded_;
  Vec2 low_;
  double tolerance_ = 0;
  std::optional<PointGrid> grid_;
  ModelChain chain_;
};

}  // namespace

std::string curve_label(const PlanarModel& model, int curve) {
  const ModelCurve& c = model.curves[static_cast<std::size_t>(curve)];
  const std::string name =
      c.name.empty() ? fmt::format("curve {}", curve + 1) : fmt::format("curve '{}'", c.name);
  return c.where.empty() ? name : fmt::format("{} ({})", name, c.where);
}

std::string point_label(const PlanarModel& model, int point) {
  const ModelPoint& p = model.points[static_cast<std::size_t>(point)];
  const std::string name =
      p.name.empty() ? fmt::format("point {}", point + 1) : fmt::format("point '{}'", p.name);
  return p.where.empty() ? name : fmt::format("{} ({})", name, p.where);
}

ModelChain chain_model(const PlanarModel& model) {
  if (model.loops.empty())
    throw InputError(prefix(model.source) + "the model has no loops: nothing bounds a domain [empty-domain]");
  return Chainer(model).run();
}

Box<Vec2> box_of(const PlanarModel& model, int chords) {
  Box<Vec2> box = Box<Vec2>::around({model.curves.at(0).shape->point(0)});
  for (const ModelCurve& curve : model.curves)
    for (int k = 0; k <= chords; ++k) box.add(curve.shape->point(static_cast<double>(k) / chords));
  return box;
}

}  // namespace delquad
