// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/planar/leave_out_small.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <queue>
#include <tuple>

#include "base/text.h"
#include "geometry/planar/encloses.h"
#include "geometry/planar/model_chain.h"

namespace delquad {

namespace {

/// Number of chords for a piece of a curve without corners.
constexpr int kChords = 32;

struct Piece {
  std::shared_ptr<const Curve> shape;
  double from, to;
};

std::vector<Vec2> points_of(const Piece& piece) {
  std::vector<Vec2> points;
  for (int k = 0; k <= kChords; ++k)
    points.push_back(
        piece.shape->point(k == kChords ? piece.to : piece.from + k * (piece.to - piece.from) / kChords));
  return points;
}

double length_of(const std::vector<Vec2>& points) {
  double length = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) length += norm(points[i + 1] - points[i]);
  return length;
}

/// A curve of consecutive pieces; not all of their ends are corners.
class JoinedCurve final : public Curve {
 public:
  JoinedCurve(std::vector<Piece> pieces, std::vector<double> fixed)
      : pieces_(std::move(pieces)), fixed_(std::move(fixed)) {}

  Vec2 point(double t) const override {
    const double at = t * static_cast<double>(pieces_.size());
    const std::size_t i = std::min(pieces_.size() - 1, static_cast<std::size_t>(std::max(0.0, at)));
    const auto& [shape, from, to] = pieces_[i];
    const double s = at - static_cast<double>(i);
    return shape->point(s < 1 ? from + s * (to - from) : to);
  }
  std::vector<double> fixed_parameters() const override { return fixed_; }

 private:
  std::vector<Piece> pieces_;
  std::vector<double> fixed_;
};

/// Consecutive curves, as pieces between their corners.
struct Chain {
  std::vector<Piece> pieces;
  std::vector<int> curve;     ///< of each piece
  std::vector<char> is_free;  ///< whether the node before each piece may be removed
  std::vector<char> is_kept;  ///< whether the node before each piece stays
  bool is_closed = false;
};

class NodeRemover {
 public:
  NodeRemover(PlanarModel& model, double length, std::vector<Warning>& warnings)
      : model_(model), chain_(chain_model(model)), length_(length), warnings_(warnings) {
    curves_at_.resize(chain_.nodes.size());
    uses_.resize(chain_.nodes.size(), 0);
    for (std::size_t c = 0; c < model.curves.size(); ++c) {
      if (model.curves[c].is_gone) continue;
      for (const int node : chain_.curve_ends[c]) curves_at_[node].push_back(static_cast<int>(c));
      for (const CurveStop& stop : chain_.stops[c]) ++uses_[stop.node];
    }
    for (const int node : chain_.point_nodes) uses_[node] += 2;
  }

  void run() {
    seen_.resize(model_.curves.size(), 0);
    for (int c = 0; c < static_cast<int>(model_.curves.size()); ++c)
      if (!seen_[c] && !model_.curves[c].is_gone) thin_out(chain_from(c));
  }

 private:
  /// Returns the curve that continues `curve` behind a node, and may be joined to it; -1: none.
  int next(int curve, int node) const {
    const std::vector<int>& two = curves_at_[node];
    if (two.size() != 2 || two[0] == two[1] || uses_[node] > 0) return -1;
    const int other = two[two[0] == curve];
    const ModelCurve &a = model_.curves[curve], &b = model_.curves[other];
    return a.name == b.name && a.is_crack == b.is_crack ? other : -1;
  }

  int other_end(int curve, int node) const {
    const auto& [a, b] = chain_.curve_ends[curve];
    return node == a ? b : a;
  }

  Chain chain_from(int curve) {
    Chain chain;
    int node = chain_.curve_ends[curve][0], first = curve;
    for (int c = curve; (c = next(c, node)) >= 0 && !chain.is_closed;) {
      if (c == curve) {
        chain.is_closed = true;
        break;
      }
      first = c;
      node = other_end(c, node);
    }
    if (chain.is_closed) first = curve, node = chain_.curve_ends[curve][0];
    for (int c = first; c >= 0 && !seen_[c]; c = next(c, node)) {
      seen_[c] = 1;
      const bool forward = chain_.curve_ends[c][0] == node;
      add(c, forward, !chain.pieces.empty(), chain);
      node = other_end(c, node);
    }
    return chain;
  }

  void add(int c, bool forward, bool follows, Chain& chain) const {
    std::vector<std::pair<double, char>> at{{0, 0}};
    for (const CurveStop& stop : chain_.stops[c])
      at.emplace_back(stop.t, uses_[stop.node] == 1 && curves_at_[stop.node].empty());
    at.emplace_back(1, 0);
    if (!forward) std::ranges::reverse(at);
    at[0].second = follows;
    for (std::size_t i = 0; i + 1 < at.size(); ++i) {
      chain.pieces.push_back({model_.curves[c].shape, at[i].first, at[i + 1].first});
      chain.curve.push_back(c);
      chain.is_free.push_back(at[i].second);
    }
  }

  void thin_out(Chain chain) {
    const int n = static_cast<int>(chain.pieces.size());
    std::vector<double> gap, turn(n + 1, std::numbers::pi);
    Vec2 last{};
    for (int i = 0; i < n; ++i) {
      const std::vector<Vec2> points = points_of(chain.pieces[i]);
      const Vec2 first = points[1] - points[0];
      if (i > 0) turn[i] = std::abs(std::atan2(cross(last, first), dot(last, first)));
      last = points[kChords] - points[kChords - 1];
      gap.push_back(length_of(points));
    }
    chain.is_kept.assign(n, 1);
    // Previous and next kept node of each node, and lengths up to the next one.
    std::vector<int> before(n + 1), behind(n + 1);
    for (int i = 0; i <= n; ++i) before[i] = i - 1, behind[i] = i + 1;
    using Gap = std::tuple<double, int, int>;
    std::priority_queue<Gap, std::vector<Gap>, std::greater<>> short_ones;
    const auto push = [&](int i) {
      if (gap[i] < length_) short_ones.emplace(gap[i], i, behind[i]);
    };
    for (int i = 0; i < n; ++i) push(i);
    const auto may_go = [&](int i) { return i > 0 && i < n && chain.is_free[i]; };
    bool is_other = false;
    while (!short_ones.empty()) {
      const auto [length, i, j] = short_ones.top();
      short_ones.pop();
      if (!(i == 0 || chain.is_kept[i]) || behind[i] != j || gap[i] != length) continue;
      if (!may_go(i) && !may_go(j)) {
        const auto& ends = chain_.curve_ends[chain.curve[i]];
        warnings_.push_back(
            {"short curves that stay", 1 / length,
             fmt::format("{} stays, {:.3g} long: {}", curve_label(model_, chain.curve[i]), length,
                         ends[0] == ends[1] ? "it is closed"
                                            : "others meet at its ends, or neighbors have other names")});
        continue;
      }
      const int gone = !may_go(i) || (may_go(j) && turn[j] < turn[i]) ? j : i;
      const auto& [shape, from, to] = chain.pieces[gone];
      warnings_.push_back(
          {"corners and ends of curves that are no nodes any more", 1 / length,
           fmt::format("{}: no node at {}, {:.3g} from the next", curve_label(model_, chain.curve[gone]),
                       show_point(shape->point(from)), length)});
      chain.is_kept[gone] = 0, is_other = true;
      behind[before[gone]] = behind[gone];
      before[behind[gone]] = before[gone];
      gap[before[gone]] += gap[gone];
      push(before[gone]);
    }
    if (is_other) put(chain);
  }

  void put(const Chain& chain) {
    for (std::size_t i = 0; i < chain.pieces.size();) {
      std::size_t end = i + 1;
      while (end < chain.pieces.size() && !(chain.is_kept[end] && chain.curve[end] != chain.curve[end - 1]))
        ++end;
      std::vector<double> fixed;
      for (std::size_t k = i + 1; k < end; ++k)
        if (chain.is_kept[k]) fixed.push_back(static_cast<double>(k - i) / static_cast<double>(end - i));
      const auto joined = std::make_shared<JoinedCurve>(
          std::vector(chain.pieces.begin() + i, chain.pieces.begin() + end), std::move(fixed));
      for (std::size_t k = i; k < end; ++k) {
        ModelCurve& curve = model_.curves[chain.curve[k]];
        curve.shape = joined;
        if (chain.curve[k] == chain.curve[i]) continue;
        curve.is_gone = true;
        for (ModelLoop& loop : model_.loops) std::erase(loop.curves, chain.curve[k]);
      }
      i = end;
    }
  }

  PlanarModel& model_;
  ModelChain chain_;
  double length_;
  std::vector<Warning>& warnings_;
  std::vector<std::vector<int>> curves_at_;  ///< curves that end at each node
  std::vector<int> uses_;                    ///< number of curves with the node inside, and of points there
  std::vector<char> seen_;                   ///< curves
};

/// Returns the points once around a loop; curves that do not join are in the order of their numbers.
std::vector<Vec2> outline(const PlanarModel& model, const ModelLoop& loop) {
  std::vector<std::vector<Vec2>> curves;
  for (const int c : loop.curves) {
    std::vector<double> at = model.curves[c].shape->fixed_parameters();
    at.insert(at.begin(), 0);
    at.push_back(1);
    std::vector<Vec2>& points = curves.emplace_back();
    for (std::size_t i = 0; i + 1 < at.size(); ++i) {
      const std::vector<Vec2> more = points_of({model.curves[c].shape, at[i], at[i + 1]});
      points.insert(points.end(), more.begin() + (i > 0), more.end());
    }
  }
  // The next curve is the one with an end nearest to the last point.
  std::vector<Vec2> points = std::move(curves[0]);
  curves.erase(curves.begin());
  while (!curves.empty()) {
    const auto off = [&](const std::vector<Vec2>& c) {
      return std::min(norm(c.front() - points.back()), norm(c.back() - points.back()));
    };
    const auto next = std::ranges::min_element(curves, {}, off);
    if (norm(next->back() - points.back()) < norm(next->front() - points.back())) std::ranges::reverse(*next);
    points.insert(points.end(), next->begin(), next->end());
    curves.erase(next);
  }
  return points;
}

void close_holes(PlanarModel& model, const SmallOutlines& small, std::vector<Warning>& warnings) {
  const std::size_t n = model.loops.size();
  std::vector<std::vector<Vec2>> outlines;
  std::vector<int> uses(model.curves.size(), 0);
  for (const ModelLoop& loop : model.loops) {
    outlines.push_back(outline(model, loop));
    for (const int c : loop.curves) ++uses[c];
  }
  const auto is_in = [&](std::size_t inner, std::size_t outer) {
    return inner != outer && encloses(outlines[outer], outlines[inner][0]);
  };
  const auto names_of = [&](const ModelLoop& loop) {
    Entity all{0, {loop.region}};
    for (const int c : loop.curves) all.names.push_back(model.curves[c].name);
    std::erase(all.names, "");
    return all;
  };
  const auto warn = [&](std::size_t l) {
    const double length = length_of(outlines[l]);
    Vec2 at{};
    for (const Vec2& x : outlines[l]) at = at + (1.0 / static_cast<double>(outlines[l].size())) * x;
    warnings.push_back({"small holes that were closed", 1 / length,
                        fmt::format("closed a hole of {:.3g} around at {}", length, show_point(at))});
    for (const std::string& name : names_of(model.loops[l]).names)
      warnings.push_back(
          {"names of small parts that are left out", 1,
           fmt::format("'{}' went with the hole at {} (--keep, or surface.keep, keeps it) [lost-names]", name,
                       show_point(at))});
  };
  std::vector<char> goes(n, 0);
  std::vector<int> host(n, -1);
  for (std::size_t l = 0; l < n; ++l) {
    const ModelLoop& loop = model.loops[l];
    const double length = length_of(outlines[l]);
    for (std::size_t k = 0; k < n && host[l] < 0; ++k)
      if (is_in(l, k) && !(length_of(outlines[k]) < small.hole)) host[l] = static_cast<int>(k);
    const bool alone = std::ranges::all_of(loop.curves, [&](int c) { return uses[c] == 1; });
    goes[l] = length < small.hole && host[l] >= 0 && alone && !small.keep.any_of(names_of(loop));
  }
  // A loop around a kept loop stays.
  for (std::size_t l = 0; l < n; ++l)
    for (std::size_t k = 0; k < n; ++k)
      if (goes[l] && is_in(k, l) && small.keep.any_of(names_of(model.loops[k]))) goes[l] = 0;
  for (std::size_t l = 0; l < n; ++l)
    if (goes[l]) warn(l);
  std::vector<ModelLoop> kept;
  for (std::size_t l = 0; l < n; ++l) {
    std::optional<std::size_t> around;
    for (std::size_t k = 0; k < n && !around; ++k)
      if (goes[k] && (k == l || is_in(l, k))) around = k;
    if (!around) {
      kept.push_back(model.loops[l]);
      continue;
    }
    const auto& shape = model.curves[model.loops[host[*around]].curves[0]].shape;
    for (const int c : model.loops[l].curves)
      model.curves[c] = {shape, "", model.curves[c].where, false, true};
  }
  model.loops = std::move(kept);
}

}  // namespace

PlanarModel leave_out_small(PlanarModel model, const SmallOutlines& small, std::vector<Warning>& warnings) {
  if (small.hole > 0) close_holes(model, small, warnings);
  if (small.length > 0) NodeRemover(model, small.length, warnings).run();
  return model;
}

}  // namespace delquad
