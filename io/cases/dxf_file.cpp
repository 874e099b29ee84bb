#include "io/cases/dxf_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/box.h"
#include "base/disjoint_sets.h"
#include "base/located.h"
#include "base/text.h"
#include "io/text_scanner.h"

namespace delquad {
namespace {

/// Of the drawing's diagonal: ends that are nearer are one.
constexpr double kGap = 1e-5;

/// A non-uniform rational B-spline, by de Boor's algorithm.
std::shared_ptr<const Curve> make_nurbs(std::size_t degree, std::vector<double> knots,
                                        std::vector<double> weights, std::vector<Vec2> points) {
  const std::size_t n = points.size();
  weights.resize(n, 1);
  if (degree < 1 || n <= degree || knots.size() != n + degree + 1 || !std::ranges::is_sorted(knots) ||
      !(knots[degree] < knots[n]) || std::ranges::any_of(weights, [](double w) { return !(w > 0); }))
    refuse(
        "a spline of degree {} with {} points and {} knots: expected {} ascending knots, and weights above 0",
        degree, n, knots.size(), n + degree + 1);
  const double first = knots[degree], last = knots[n];
  return make_parametric_curve(
      [degree, knots = std::move(knots), weights = std::move(weights), points = std::move(points),
       n](double t) {
        const auto after = std::upper_bound(knots.begin() + static_cast<std::ptrdiff_t>(degree) + 1,
                                            knots.begin() + static_cast<std::ptrdiff_t>(n), t);
        const std::size_t span = static_cast<std::size_t>(after - knots.begin()) - 1;
        std::vector<Vec3> d;
        for (std::size_t i = span - degree; i <= span; ++i)
          d.push_back({weights[i] * points[i].x, weights[i] * points[i].y, weights[i]});
        for (std::size_t r = 1; r <= degree; ++r)
          for (std::size_t j = degree; j >= r; --j) {
            const std::size_t i = j + span - degree;
            const double a = (t - knots[i]) / (knots[i + 1 + degree - r] - knots[i]);
            d[j] = (1 - a) * d[j - 1] + a * d[j];
          }
        return Vec2{d[degree].x / d[degree].z, d[degree].y / d[degree].z};
      },
      first, last);
}

/// A curve with other ends, near its own.
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

class DxfReader {
 public:
  explicit DxfReader(const std::filesystem::path& path) : in_(path) {
    model_.source = path.string();
    if (in_.text().starts_with("AutoCAD Binary DXF")) in_.fail("binary DXF: expected it as text");
    bool in_entities = false;
    for (next(); value_ != "EOF"; next()) {
      if (code_ == 2) in_entities = value_ == "ENTITIES";
      while (code_ == 0 && in_entities && value_ != "ENDSEC") entity();
      if (value_ == "EOF") break;
    }
    if (!model_.curves.empty()) join_ends();
    if (model_.loops.empty()) refuse("{}: no curves close up to an outline", model_.source);
  }
  PlanarModel model() { return std::move(model_); }

 private:
  struct Corner {
    Vec2 at;
    double bulge = 0;  ///< tangent of a fourth of the angle of the arc that begins here
  };

  void next() {
    code_ = static_cast<int>(in_.integer("a group code", -5, 1071));
    if (!in_.next_line()) in_.fail("the file ends within a group: expected EOF");
    value_ = std::string(trimmed(in_.rest_of_line()));
    in_.next_line();
  }
  double number() const {
    const auto value = as_number(value_);
    if (!value || !std::isfinite(*value))
      in_.fail_at(in_.line() - 1, "group {} is {}: expected a number", code_, TextScanner::printable(value_));
    return *value;
  }

  /// One entity, up to what follows it.
  void entity() {
    const std::string kind = value_, where = in_.place(static_cast<std::size_t>(in_.line()) - 1);
    layer_.clear(), values_.clear(), corners_.clear(), fit_.clear(), knots_.clear(), weights_.clear();
    groups(kind);
    if (kind == "POLYLINE") {
      const auto of_line = values_;
      while (value_ == "VERTEX") groups("LWPOLYLINE");
      values_ = of_line;
    }
    where_ = where + ": " + kind;
    located(where_, [&] { add(kind); });
  }

  /// The groups behind one of code 0, up to the next.
  void groups(const std::string& kind) {
    const bool is_polyline = kind == "LWPOLYLINE", is_spline = kind == "SPLINE";
    for (next(); code_ != 0; next()) {
      if (code_ == 8) layer_ = value_ == "0" ? "" : value_;
      if (code_ < 10 || (code_ > 79 && code_ != 230)) continue;
      const double value = number();
      if (code_ == 10 && (is_polyline || is_spline)) corners_.push_back({{value, 0}});
      if (code_ == 20 && !corners_.empty()) corners_.back().at.y = value;
      if (code_ == 42 && is_polyline && !corners_.empty()) corners_.back().bulge = value;
      if (code_ == 40 && is_spline) knots_.push_back(value);
      if (code_ == 41 && is_spline) weights_.push_back(value);
      if (code_ == 11 && is_spline) fit_.push_back({value, 0});
      if (code_ == 21 && !fit_.empty()) fit_.back().y = value;
      values_[code_] = value;
    }
  }

  double value(int code, double otherwise = 0) const {
    const auto at = values_.find(code);
    return at == values_.end() ? otherwise : at->second;
  }
  Vec2 point(int code) const { return {value(code), value(code + 10)}; }

  void add(const std::string& kind) {
    constexpr double kDegree = std::numbers::pi / 180;
    // Of shapes that have a plane: seen from below x points to the left.
    const double side = value(230, 1) < 0 ? -1 : 1;
    const Vec2 centre{side * value(10), value(20)};
    if (kind == "LINE") {
      if (point(10) != point(11)) push(make_segment(point(10), point(11)));
    } else if (kind == "CIRCLE") {
      push(make_circle(centre, value(40)));
    } else if (kind == "ARC") {
      const double from = value(50), turn = std::fmod(value(51) - from + 720, 360);
      const double begin = side > 0 ? from : 180 - from;
      push(make_arc(centre, value(40), begin * kDegree, (begin + side * (turn > 0 ? turn : 360)) * kDegree));
    } else if (kind == "ELLIPSE") {
      const Vec2 a = point(11), b{side * -value(40) * a.y, side * value(40) * a.x}, c = point(10);
      const double from = value(41), to = value(42, 2 * std::numbers::pi);
      push(make_parametric_curve([=](double t) { return c + std::cos(t) * a + std::sin(t) * b; }, from,
                                 to > from ? to : to + 2 * std::numbers::pi));
    } else if (kind == "LWPOLYLINE" || kind == "POLYLINE") {
      add_polyline(side);
    } else if (kind == "SPLINE") {
      std::vector<Vec2> points;
      for (const Corner& corner : corners_) points.push_back(corner.at);
      if (!points.empty())
        push(make_nurbs(static_cast<std::size_t>(std::max(0., value(71))), knots_, weights_, points));
      else
        push(make_spline(fit_));
    } else if (kind == "POINT") {
      model_.points.push_back({point(10), layer_, where_});
    } else if (kind == "INSERT") {
      refuse("a block: explode it before");
    }
  }

  /// Straight parts, and an arc for each bulge.
  void add_polyline(double side) {
    for (Corner& corner : corners_) corner.at.x *= side, corner.bulge *= side;
    if (corners_.empty()) return;
    if ((static_cast<int>(value(70)) & 1) != 0) corners_.push_back({corners_[0].at});
    std::vector<Vec2> straight{corners_[0].at};
    const auto end_straight = [&](Vec2 at) {
      if (straight.size() > 1) push(make_polyline(straight));
      straight = {at};
    };
    for (std::size_t i = 0; i + 1 < corners_.size(); ++i) {
      const Vec2 a = corners_[i].at, b = corners_[i + 1].at;
      const double bulge = corners_[i].bulge;
      if (a == b) continue;
      if (bulge == 0) {
        straight.push_back(b);
        continue;
      }
      end_straight(b);
      const Vec2 d = b - a, centre = a + 0.5 * d + (1 - bulge * bulge) / (4 * bulge) * Vec2{-d.y, d.x};
      const double from = std::atan2(a.y - centre.y, a.x - centre.x);
      push(make_arc(centre, norm(a - centre), from, from + 4 * std::atan(bulge)));
    }
    end_straight({});
  }

  void push(std::shared_ptr<const Curve> shape) {
    model_.curves.push_back({std::move(shape), layer_, where_});
  }

  /// Curves that hang together are a loop where each end of theirs meets another; those that end alone, and
  /// what then does, stand in regions.
  void join_ends() {
    std::vector<ModelCurve>& curves = model_.curves;
    std::vector<Vec2> ends;
    for (const ModelCurve& curve : curves)
      for (const double t : {0., 1.}) ends.push_back(curve.shape->point(t));
    const Vec2 extent = Box<Vec2>::around(std::span<const Vec2>(ends)).size();
    const double gap = kGap * norm(extent);
    std::vector<std::size_t> order(ends.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::sort(order, {}, [&](std::size_t e) { return std::pair{ends[e].x, e}; });
    DisjointSets nodes(ends.size());
    for (std::size_t i = 0; i < order.size(); ++i)
      for (std::size_t j = i + 1; j < order.size() && ends[order[j]].x - ends[order[i]].x <= gap; ++j)
        if (norm(ends[order[j]] - ends[order[i]]) <= gap)
          nodes.join(static_cast<int>(order[i]), static_cast<int>(order[j]));
    const std::vector<int> node = nodes.roots();
    std::vector<std::vector<int>> at_node(ends.size());
    for (std::size_t e = 0; e < ends.size(); ++e) at_node[node[e]].push_back(static_cast<int>(e / 2));
    std::vector<bool> open(curves.size(), false);
    std::vector<int> lone;
    for (std::size_t v = 0; v < at_node.size(); ++v)
      if (at_node[v].size() == 1) lone.push_back(static_cast<int>(v));
    while (!lone.empty()) {
      const int v = lone.back();
      lone.pop_back();
      if (at_node[v].size() != 1) continue;
      const int c = at_node[v][0];
      open[c] = true;
      for (const int e : {2 * c, 2 * c + 1}) {
        std::erase(at_node[node[e]], c);
        if (at_node[node[e]].size() == 1) lone.push_back(node[e]);
      }
    }
    DisjointSets together(curves.size());
    for (std::size_t v = 0; v < at_node.size(); ++v) {
      for (const int c : at_node[v]) together.join(at_node[v][0], c);
      if (at_node[v].size() % 2 == 1)
        refuse("{}: {} curves meet at {}, of which one is on {}: expected outlines that are apart",
               model_.source, at_node[v].size(), show_point(ends[v]), curves[at_node[v][0]].where);
    }
    std::vector<int> loop_of(curves.size(), -1);
    for (std::size_t c = 0; c < curves.size(); ++c) {
      const Vec2 from = ends[node[2 * c]], to = ends[node[2 * c + 1]];
      if (from != ends[2 * c] || to != ends[2 * c + 1])
        curves[c].shape = std::make_shared<MovedEnds>(curves[c].shape, from, to);
      if (open[c]) continue;
      int& loop = loop_of[together.root(static_cast<int>(c))];
      if (loop < 0) {
        loop = static_cast<int>(model_.loops.size());
        model_.loops.push_back({{}, "", curves[c].where});
      }
      model_.loops[loop].curves.push_back(static_cast<int>(c));
    }
  }

  TextScanner in_;
  PlanarModel model_;
  int code_ = -1;
  std::string value_, layer_, where_;
  std::map<int, double> values_;  ///< by group code; of several the last
  std::vector<Corner> corners_;
  std::vector<Vec2> fit_;
  std::vector<double> knots_, weights_;
};

}  // namespace

PlanarModel read_dxf(const std::filesystem::path& path) { return DxfReader(path).model(); }

}  // namespace delquad
