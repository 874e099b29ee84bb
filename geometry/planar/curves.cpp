#include "delquad/model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/located.h"
#include "delquad/error.h"

namespace delquad {

namespace {

/// An arc whose sweep differs from a full turn by less (radians) is a full turn: what twelve printed digits
/// leave.
constexpr double kFullTurnTolerance = 1e-11;

void require_finite(double value, const char* what) {
  if (!std::isfinite(value))
    throw InputError(fmt::format("{} is {}; a finite number was expected", what, value));
}

void require_finite(Vec2 p, const std::string& what) {
  if (!std::isfinite(p.x) || !std::isfinite(p.y))
    throw InputError(fmt::format("{} is ({}, {}); finite coordinates were expected", what, p.x, p.y));
}

class Polyline final : public Curve {
 public:
  explicit Polyline(std::vector<Vec2> points) : points_(std::move(points)) {
    // Equal parameter spans, not lengths: a tiny edge beside a huge one keeps a span of its own.
    const std::size_t n = points_.size() - 1;
    for (std::size_t i = 0; i <= n; ++i) knots_.push_back(static_cast<double>(i) / static_cast<double>(n));
  }

  Vec2 point(double t) const override {
    const auto after = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, t);
    const std::size_t i = static_cast<std::size_t>(after - knots_.begin()) - 1;
    const double s = (t - knots_[i]) / (knots_[i + 1] - knots_[i]);
    if (s <= 0) return points_[i];
    if (s >= 1) return points_[i + 1];
    const Vec2 a = points_[i], b = points_[i + 1];
    return s < 0.5 ? a + s * (b - a) : b + (1 - s) * (a - b);
  }

  std::vector<double> fixed_parameters() const override { return {knots_.begin() + 1, knots_.end() - 1}; }

 private:
  std::vector<Vec2> points_;
  std::vector<double> knots_;
};

class Arc final : public Curve {
 public:
  Arc(Vec2 centre, double radius, double angle0, double angle1)
      : centre_(centre), radius_(radius), angle0_(angle0), angle1_(angle1) {
    const double sweep = std::abs(angle1 - angle0);
    closed_ = std::abs(sweep - 2 * std::numbers::pi) < kFullTurnTolerance;
  }

  Vec2 point(double t) const override {
    const double angle = t < 1 ? angle0_ + t * (angle1_ - angle0_) : closed_ ? angle0_ : angle1_;
    return centre_ + radius_ * Vec2{std::cos(angle), std::sin(angle)};
  }

 private:
  Vec2 centre_;
  double radius_, angle0_, angle1_;
  bool closed_;
};

class ParametricCurve final : public Curve {
 public:
  ParametricCurve(std::function<Vec2(double)> point, double t0, double t1)
      : point_(std::move(point)), t0_(t0), t1_(t1) {}

  Vec2 point(double s) const override { return point_(s < 1 ? t0_ + s * (t1_ - t0_) : t1_); }

 private:
  std::function<Vec2(double)> point_;
  double t0_, t1_;
};

}  // namespace

std::shared_ptr<const Curve> make_segment(Vec2 a, Vec2 b) {
  require_finite(a, "the segment's start");
  require_finite(b, "the segment's end");
  if (a == b) throw InputError(fmt::format("the segment has no length: both ends are ({}, {})", a.x, a.y));
  return std::make_shared<Polyline>(std::vector{a, b});
}

std::shared_ptr<const Curve> make_polyline(std::vector<Vec2> points) {
  if (points.size() < 2)
    throw InputError(fmt::format("the polyline has {} points; at least two were expected", points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    require_finite(points[i], fmt::format("point {} of the polyline", i + 1));
    if (i > 0 && points[i] == points[i - 1])
      throw InputError(
          fmt::format("the polyline has a zero-length segment: points {} and {} are both ({}, {})", i, i + 1,
                      points[i].x, points[i].y));
  }
  return std::make_shared<Polyline>(std::move(points));
}

std::shared_ptr<const Curve> make_arc(Vec2 centre, double radius, double angle0, double angle1) {
  require_finite(centre, "the arc's centre");
  require_finite(angle0, "the arc's first angle");
  require_finite(angle1, "the arc's last angle");
  if (!std::isfinite(radius) || !(radius > 0))
    throw InputError(fmt::format("the radius is {}; a number above 0 was expected", radius));
  if (angle0 == angle1) throw InputError(fmt::format("the arc has no length: both angles are {}", angle0));
  if (std::abs(angle1 - angle0) > 2 * std::numbers::pi + kFullTurnTolerance)
    throw InputError(fmt::format("the arc from angle {} to {} (radians) runs over itself; one turn at most",
                                 angle0, angle1));
  return std::make_shared<Arc>(centre, radius, angle0, angle1);
}

std::shared_ptr<const Curve> make_circle(Vec2 centre, double radius) {
  return make_arc(centre, radius, 0, 2 * std::numbers::pi);
}

std::shared_ptr<const Curve> make_parametric_curve(std::function<Vec2(double)> point, double t0, double t1) {
  require_finite(t0, "the curve's first parameter");
  require_finite(t1, "the curve's last parameter");
  if (t0 == t1) throw InputError(fmt::format("the curve has no length: t runs from {} to {}", t0, t1));
  return std::make_shared<ParametricCurve>(std::move(point), t0, t1);
}

PlanarModel polygons(const std::vector<std::vector<Vec2>>& loops) {
  PlanarModel model{"polygons", {}, {}};
  if (loops.empty()) throw InputError("polygons: there are none");
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const std::string name = fmt::format("polygon {}", i + 1);
    std::vector<Vec2> corners = loops[i];
    if (corners.size() < 3)
      throw InputError(fmt::format("{}: {} corners: at least three were expected", name, corners.size()));
    if (corners.front() == corners.back())
      throw InputError(
          fmt::format("{}: its last corner, ({}, {}), is its first one again: it closes by itself", name,
                      corners[0].x, corners[0].y));
    corners.push_back(corners[0]);
    model.curves.push_back({located(name, [&] { return make_polyline(corners); }), "", name});
    model.loops.push_back({{static_cast<int>(i)}, "", name});
  }
  return model;
}

}  // namespace delquad
