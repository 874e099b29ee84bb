#include "geometry/planar/model_chain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "base/box.h"
#include "delquad/error.h"

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

// A few points of each curve tell the model's extent and which curves have none. A prime number of parts, so
// that no periodic formula hides from them.
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
          throw InputError(fmt::format("{}{} is ({}, {}) at {} of its way; finite coordinates were expected",
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
    partner_.assign(ends_.size(), -1);
  }

  ModelChain run() {
    ModelChain chain;
    chain.loops = merge_loops();
    for (const ModelLoop& loop : chain.loops) close(loop);
    chain.curve_ends.resize(model_.curves.size());
    std::vector<int> node(ends_.size(), -1);
    for (std::size_t e = 0; e < ends_.size(); ++e) {
      if (node[e] < 0) {
        node[e] = node[static_cast<std::size_t>(partner_[e])] = static_cast<int>(chain.nodes.size());
        chain.nodes.push_back(ends_[e]);
      }
      chain.curve_ends[e / 2][e % 2] = node[e];
    }
    return chain;
  }

 private:
  std::string label(End e) const { return curve_label(model_, e / 2); }
  Vec2 at(End e) const { return ends_[static_cast<std::size_t>(e)]; }

  // Loops by their set of curves; the filling of a hole may be a loop of its own.
  std::vector<ModelLoop> merge_loops() const {
    std::vector<ModelLoop> merged;
    std::vector<int> owner(model_.curves.size(), -1), first_index;
    for (std::size_t l = 0; l < model_.loops.size(); ++l) {
      const ModelLoop& loop = model_.loops[l];
      check_curves(loop, static_cast<int>(l));
      int other = -1;
      for (int c : loop.curves) other = std::max(other, owner[static_cast<std::size_t>(c)]);
      if (other < 0) {
        for (int c : loop.curves) owner[static_cast<std::size_t>(c)] = static_cast<int>(merged.size());
        merged.push_back(loop);
        first_index.push_back(static_cast<int>(l));
        continue;
      }
      ModelLoop& twin = merged[static_cast<std::size_t>(other)];
      std::vector<int> a = loop.curves, b = twin.curves;
      std::ranges::sort(a);
      std::ranges::sort(b);
      const std::string both =
          fmt::format("{} and {}", loop_label(model_, first_index[static_cast<std::size_t>(other)]),
                      loop_label(model_, static_cast<int>(l)));
      if (a != b)
        throw InputError(fmt::format("{}{} share some of their curves; two loops may share all or none",
                                     prefix(model_.source), both));
      if (twin.region.empty() == loop.region.empty())
        throw InputError(fmt::format("{}{} consist of the same curves: one of them is too many",
                                     prefix(model_.source), both));
      if (twin.region.empty()) twin.region = loop.region;
    }
    for (std::size_t c = 0; c < owner.size(); ++c)
      if (owner[c] < 0)
        throw InputError(fmt::format("{}{} belongs to no loop", prefix(model_.source),
                                     curve_label(model_, static_cast<int>(c))));
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

  // Pairs the ends of the loop's curves and walks round once.
  void close(const ModelLoop& loop) {
    std::vector<End> ends;
    for (int c : loop.curves) ends.insert(ends.end(), {2 * c, 2 * c + 1});
    const std::string where = prefix(loop.where.empty() ? model_.source : loop.where);
    pair_up(ends, where);
    std::size_t walked = 0;
    End e = ends[0];
    do {
      ++walked;
      e = partner_[static_cast<std::size_t>(e ^ 1)];
    } while (e != ends[0]);
    if (walked != loop.curves.size())
      throw InputError(
          fmt::format("{}the loop's curves close to more than one chain: {} of {} curves lie on that of {}",
                      where, walked, loop.curves.size(), label(ends[0])));
  }

  void pair_up(const std::vector<End>& ends, const std::string& where) {
    using Cell = std::pair<long long, long long>;
    const auto cell = [&](End e) {
      const Vec2 d = at(e) - low_;
      return Cell{static_cast<long long>(d.x / tolerance_), static_cast<long long>(d.y / tolerance_)};
    };
    std::map<Cell, std::vector<End>> grid;
    for (End e : ends) grid[cell(e)].push_back(e);
    std::vector<End> loose;
    for (End e : ends) {
      std::vector<End> near;
      const auto [cx, cy] = cell(e);
      for (long long x = cx - 1; x <= cx + 1; ++x)
        for (long long y = cy - 1; y <= cy + 1; ++y)
          if (const auto found = grid.find({x, y}); found != grid.end())
            for (End other : found->second)
              if (other != e && norm(at(other) - at(e)) <= tolerance_) near.push_back(other);
      if (near.size() > 1)
        throw InputError(fmt::format(
            "{}{} ends of curves meet at ({}, {}): of {}, {} and {}; a loop joins them two by two", where,
            near.size() + 1, at(e).x, at(e).y, label(e), label(near[0]), label(near[1])));
      if (near.empty())
        loose.push_back(e);
      else
        partner_[static_cast<std::size_t>(e)] = near[0];
    }
    if (!loose.empty()) report_open(loose, where);
  }

  // All other ends are in pairs, so there are at least two.
  [[noreturn]] void report_open(const std::vector<End>& loose, const std::string& where) const {
    const End e = loose[0];
    const End nearest = *std::min_element(loose.begin() + 1, loose.end(), [&](End a, End b) {
      return norm(at(a) - at(e)) < norm(at(b) - at(e));
    });
    throw InputError(fmt::format("{}the loop is open between ({}, {}), an end of {}, and ({}, {}) of {}",
                                 where, at(e).x, at(e).y, label(e), at(nearest).x, at(nearest).y,
                                 label(nearest)));
  }

  const PlanarModel& model_;
  std::vector<Vec2> ends_;
  std::vector<End> partner_;
  Vec2 low_;
  double tolerance_ = 0;
};

}  // namespace

std::string curve_label(const PlanarModel& model, int curve) {
  const ModelCurve& c = model.curves[static_cast<std::size_t>(curve)];
  const std::string name =
      c.name.empty() ? fmt::format("curve {}", curve + 1) : fmt::format("curve '{}'", c.name);
  return c.where.empty() ? name : fmt::format("{} ({})", name, c.where);
}

ModelChain chain_model(const PlanarModel& model) {
  if (model.loops.empty())
    throw InputError(prefix(model.source) + "the model has no loops: nothing bounds a domain");
  return Chainer(model).run();
}

}  // namespace delquad
