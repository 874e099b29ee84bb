// SPDX-License-Identifier: GPL-3.0-or-later
#include "delquad/model.h"

#include <fmt/format.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <span>

#include "base/located.h"
#include "delquad/error.h"
#include "geometry/planar/defined_curve.h"

namespace delquad {

namespace {

/// Tolerance (radians) within which a sweep is a full turn, for angles with twelve printed digits.
constexpr double kFullTurnTolerance = 1e-11;

void require_finite(double value, const char* what) {
  if (!std::isfinite(value)) throw InputError(fmt::format("{} is {}: expected a finite number", what, value));
}

void require_finite(Vec2 p, const std::string& what) {
  if (!std::isfinite(p.x) || !std::isfinite(p.y))
    throw InputError(fmt::format("{} is ({}, {}): expected finite coordinates", what, p.x, p.y));
}

void check_points(std::span<const Vec2> points, const char* what) {
  if (points.size() < 2)
    throw InputError(fmt::format("the {} has {} points: expected at least two", what, points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    require_finite(points[i], fmt::format("point {} of the {}", i + 1, what));
    if (i > 0 && points[i] == points[i - 1])
      throw InputError(fmt::format("the {} has a zero-length segment: points {} and {} are both ({}, {})",
                                   what, i, i + 1, points[i].x, points[i].y));
  }
}

/// Returns the angle by which a polyline turns at b, radians from 0 to pi.
double turn(Vec2 a, Vec2 b, Vec2 c) { return std::abs(std::atan2(cross(b - a, c - b), dot(b - a, c - b))); }

/// Returns the coordinates with every bit.
std::string exact_text(std::span<const Vec2> points) {
  std::string text;
  for (const Vec2 p : points) text += fmt::format(" {:a} {:a}", p.x, p.y);
  return text;
}

class Polyline final : public DefinedCurve {
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
  std::string definition() const override { return "polyline" + exact_text(points_); }

 private:
  std::vector<Vec2> points_;
  std::vector<double> knots_;
};

/// Returns second derivatives by t at the knots of the natural or periodic cubic spline through these points.
std::vector<Vec2> second_derivatives(std::span<const double> t, std::span<const Vec2> points,
                                     bool is_periodic) {
  const int n = static_cast<int>(points.size()) - 1;
  const int unknowns = is_periodic ? n : n - 1, first = is_periodic ? 0 : 1;
  std::vector<Vec2> second(points.size());
  if (unknowns < 1) return second;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixX2d jump = Eigen::MatrixX2d::Zero(unknowns, 2);
  for (int i = 0; i < n; ++i) {  // each chord gives its share to the equations at both ends
    const double h = t[i + 1] - t[i];
    const Vec2 slope = (1 / h) * (points[i + 1] - points[i]);
    const int at[2] = {i - first, is_periodic ? (i + 1) % n : i};
    for (const int k : {0, 1}) {
      if (at[k] < 0 || at[k] >= unknowns) continue;
      entries.emplace_back(at[k], at[k], h / 3);
      if (at[1 - k] >= 0 && at[1 - k] < unknowns) entries.emplace_back(at[k], at[1 - k], h / 6);
      jump.row(at[k]) += (k == 0 ? 1 : -1) * Eigen::RowVector2d(slope.x, slope.y);
    }
  }
  Eigen::SparseMatrix<double> matrix(unknowns, unknowns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::MatrixX2d solution = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(jump);
  for (int i = 0; i < unknowns; ++i) second[i + first] = {solution(i, 0), solution(i, 1)};
  if (is_periodic) second[n] = second[0];
  return second;
}

class Spline final : public DefinedCurve {
 public:
  Spline(std::vector<Vec2> points, double corner) : points_(std::move(points)), t_{0}, corner_(corner) {
    const std::size_t n = points_.size() - 1;
    const bool is_closed = points_[0] == points_[n];
    const auto turns = [&](std::size_t i) {  // at point i, which has neighbors on both sides
      return turn(points_[(i + n - 1) % n], points_[i], points_[i + 1]) > corner;
    };
    if (is_closed && !turns(0)) {  // it begins at a corner, if it has one
      std::size_t first = 1;
      while (first < n && !turns(first)) ++first;
      points_.pop_back();
      std::ranges::rotate(points_, points_.begin() + static_cast<std::ptrdiff_t>(first % n));
      points_.push_back(points_[0]);
    }
    for (std::size_t i = 0; i < n; ++i) t_.push_back(t_[i] + norm(points_[i + 1] - points_[i]));
    const double length = t_[n];
    for (double& t : t_) t /= length;
    for (std::size_t from = 0, to = 1; from < n; from = to++) {
      while (to < n && !turns(to)) ++to;
      if (to < n) fixed_.push_back(t_[to]);
      const std::size_t count = to - from + 1;
      const std::vector<Vec2> second =
          second_derivatives(std::span(t_).subspan(from, count), std::span(points_).subspan(from, count),
                             is_closed && count == n + 1 && !turns(0));
      for (std::size_t i = 0; i + 1 < count; ++i) second_.push_back({second[i], second[i + 1]});
    }
  }

  Vec2 point(double t) const override {
    const auto after = std::upper_bound(t_.begin() + 1, t_.end() - 1, t);
    const std::size_t i = static_cast<std::size_t>(after - t_.begin()) - 1;
    const double h = t_[i + 1] - t_[i], b = (t - t_[i]) / h, a = 1 - b;
    if (b <= 0) return points_[i];
    if (b >= 1) return points_[i + 1];
    return a * points_[i] + b * points_[i + 1] +
           (h * h / 6) * ((a * a * a - a) * second_[i][0] + (b * b * b - b) * second_[i][1]);
  }

  std::vector<double> fixed_parameters() const override { return fixed_; }
  std::string definition() const override {
    return fmt::format("spline{} corner {:a}", exact_text(points_), corner_);
  }

 private:
  std::vector<Vec2> points_;
  std::vector<double> t_;                    ///< at each, by the length of chords
  std::vector<std::array<Vec2, 2>> second_;  ///< derivatives at the ends of each chord
  std::vector<double> fixed_;
  double corner_;
};

class Arc final : public DefinedCurve {
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
  std::string definition() const override {
    return fmt::format("arc {:a} {:a} {:a} {:a} {:a}", centre_.x, centre_.y, radius_, angle0_, angle1_);
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
  check_points(points, "polyline");
  return std::make_shared<Polyline>(std::move(points));
}

std::shared_ptr<const Curve> make_spline(std::vector<Vec2> points, double corner) {
  check_points(points, "spline");
  require_finite(corner, "the angle of the spline's corners");
  return std::make_shared<Spline>(std::move(points), corner);
}

std::shared_ptr<const Curve> make_arc(Vec2 centre, double radius, double angle0, double angle1) {
  require_finite(centre, "the arc's centre");
  require_finite(angle0, "the arc's first angle");
  require_finite(angle1, "the arc's last angle");
  if (!std::isfinite(radius) || !(radius > 0))
    throw InputError(fmt::format("the radius is {}: expected a number above 0", radius));
  if (angle0 == angle1) throw InputError(fmt::format("the arc has no length: both angles are {}", angle0));
  if (std::abs(angle1 - angle0) > 2 * std::numbers::pi + kFullTurnTolerance)
    throw InputError(fmt::format(
        "the arc from angle {} to {} (radians) overlaps itself: expected at most one turn", angle0, angle1));
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
      throw InputError(fmt::format("{}: {} corners: expected at least three", name, corners.size()));
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
