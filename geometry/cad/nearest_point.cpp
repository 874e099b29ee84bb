#include "geometry/cad/nearest_point.h"

#include <algorithm>
#include <cmath>
#include <gp_Pnt.hxx>
#include <gp_Vec.hxx>
#include <limits>

namespace delquad::cad {

namespace {

/// Newton converges in 3 to 5 steps; more are needed only at kinks and poles.
constexpr int kMostSteps = 50;
constexpr int kMostHalvings = 30;
/// Steps shorter than this many tolerances are taken as they are: rounding hides what the distance gains.
constexpr double kSure = 1e4;

/// The parameters that a variable may take.
struct Range {
  double low, high;
  double clamp(double t) const { return std::clamp(t, low, high); }
  /// True when a step would leave at once.
  bool stops(double t, double step) const { return (t <= low && step < 0) || (t >= high && step > 0); }
};

struct SurfaceRange {
  Range u, v;
  explicit SurfaceRange(const Geom_Surface& surface) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    surface.Bounds(u.low, u.high, v.low, v.high);
    if (surface.IsUPeriodic()) u = {-kInfinity, kInfinity};
    if (surface.IsVPeriodic()) v = {-kInfinity, kInfinity};
  }
};

struct Step {
  double u = 0, v = 0;
};

/// The step from S(u, v) towards the nearest point: Newton's where the distance is convex, else that of the
/// tangent plane; a variable that may not move stays.
Step newton_step(const gp_Vec& r, const gp_Vec& du, const gp_Vec& dv, const gp_Vec& duu, const gp_Vec& dvv,
                 const gp_Vec& duv, double u, double v, const SurfaceRange& range) {
  const double gu = r.Dot(du), gv = r.Dot(dv);
  const double e = du.Dot(du), f = du.Dot(dv), g = dv.Dot(dv);
  const auto along = [](double gradient, double curvature, double first) {
    const double divisor = curvature > 0 ? curvature : first;
    return divisor > 0 ? -gradient / divisor : 0;
  };
  const Step only_u{along(gu, e + r.Dot(duu), e), 0}, only_v{0, along(gv, g + r.Dot(dvv), g)};
  const auto solve = [&](double a, double b, double c) {
    const double det = a * c - b * b;
    return Step{(b * gv - c * gu) / det, (b * gu - a * gv) / det};
  };
  // Relative to the product: a smaller determinant is rounding (a pole, parallel tangents).
  constexpr double kSingular = 1e-14;
  const auto is_definite = [](double a, double b, double c) {
    return a > 0 && c > 0 && a * c - b * b > kSingular * a * c;
  };
  Step step;
  if (const double a = e + r.Dot(duu), b = f + r.Dot(duv), c = g + r.Dot(dvv); is_definite(a, b, c)) {
    step = solve(a, b, c);
  } else if (is_definite(e, f, g)) {
    step = solve(e, f, g);
  } else {
    step = e >= g ? only_u : only_v;
  }
  if (range.u.stops(u, step.u)) step = range.v.stops(v, only_v.v) ? Step{} : only_v;
  if (range.v.stops(v, step.v)) step = range.u.stops(u, only_u.u) ? Step{} : only_u;
  return step;
}

}  // namespace

gp_Pnt nearest_point(const Geom_Surface& surface, const gp_Pnt& x, double u, double v, double tolerance) {
  const SurfaceRange range(surface);
  u = range.u.clamp(u);
  v = range.v.clamp(v);
  gp_Pnt p;
  gp_Vec du, dv, duu, dvv, duv;
  for (int i = 0; i < kMostSteps; ++i) {
    surface.D2(u, v, p, du, dv, duu, dvv, duv);
    const gp_Vec r(x, p);
    const Step step = newton_step(r, du, dv, duu, dvv, duv, u, v, range);
    const double moved = (step.u * du + step.v * dv).Magnitude();
    // The error left is that of the next step: its square.
    const bool last = moved < tolerance;
    double fraction = 1;
    gp_Pnt q;
    for (int k = 0; k < kMostHalvings; ++k, fraction /= 2) {
      q = surface.Value(range.u.clamp(u + fraction * step.u), range.v.clamp(v + fraction * step.v));
      if (moved < kSure * tolerance || q.SquareDistance(x) <= r.SquareMagnitude()) break;
    }
    u = range.u.clamp(u + fraction * step.u);
    v = range.v.clamp(v + fraction * step.v);
    p = q;
    if (last) break;
  }
  return p;
}

gp_Pnt nearest_point(const Geom_Curve& curve, double first, double last, const gp_Pnt& x, double t,
                     double tolerance) {
  const Range range{first, last};
  t = range.clamp(t);
  gp_Pnt p;
  gp_Vec d1, d2;
  for (int i = 0; i < kMostSteps; ++i) {
    curve.D2(t, p, d1, d2);
    const gp_Vec r(x, p);
    const double slope2 = d1.SquareMagnitude();
    const double curvature = slope2 + r.Dot(d2);
    const double divisor = curvature > 0 ? curvature : slope2;
    double step = divisor > 0 ? -r.Dot(d1) / divisor : 0;
    if (range.stops(t, step)) step = 0;
    const double moved = std::abs(step) * std::sqrt(slope2);
    const bool done = moved < tolerance;
    for (int k = 0; k < kMostHalvings && moved > kSure * tolerance; ++k, step /= 2)
      if (curve.Value(range.clamp(t + step)).SquareDistance(x) <= r.SquareMagnitude()) break;
    t = range.clamp(t + step);
    p = curve.Value(t);
    if (done) break;
  }
  return p;
}

}  // namespace delquad::cad
