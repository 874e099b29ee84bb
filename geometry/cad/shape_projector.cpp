// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/shape_projector.h"

#include <BRep_Tool.hxx>
#include <ElSLib.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_Curve.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Plane.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_Surface.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopoDS_Vertex.hxx>
#include <gp_Pnt.hxx>
#include <gp_Vec.hxx>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <variant>

#include "base/cancel.h"
#include "base/segment.h"
#include "geometry/mesh/nearest_triangle.h"

namespace delquad::cad {

namespace {

/// Limit of Newton's steps: usually 3 to 5, more only at kinks and poles.
constexpr int kMostSteps = 50;
constexpr int kMostHalvings = 30;
/// Length of steps, in tolerances, that are accepted without a test, since rounding hides their gain.
constexpr double kRoundingFactor = 1e4;

/// Range of a parameter.
struct ParameterRange {
  double low, high;
  double clamp(double t) const { return std::clamp(t, low, high); }
  /// Returns whether a step would leave the range at once.
  bool stops(double t, double step) const { return (t <= low && step < 0) || (t >= high && step > 0); }
};

struct SurfaceRange {
  ParameterRange u, v;
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

/// Returns the step from S(u, v) towards the nearest point: Newton's if the distance is convex, else by the
/// tangent plane. A parameter at the end of its range stays.
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
  // Determinant over the product below which it is rounding (a pole, parallel tangents).
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

/// Returns the point of a surface nearest to x, by damped Newton steps from the guess S(u, v). Stops if a
/// step is shorter than `tolerance`, a length.
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
    // The remaining error is about the square of the last step.
    const bool last = moved < tolerance;
    double fraction = 1;
    gp_Pnt q;
    for (int k = 0; k < kMostHalvings; ++k, fraction /= 2) {
      q = surface.Value(range.u.clamp(u + fraction * step.u), range.v.clamp(v + fraction * step.v));
      if (moved < kRoundingFactor * tolerance || q.SquareDistance(x) <= r.SquareMagnitude()) break;
    }
    u = range.u.clamp(u + fraction * step.u);
    v = range.v.clamp(v + fraction * step.v);
    p = q;
    if (last) break;
  }
  return p;
}

/// Returns the same on the part [first, last] of a curve.
gp_Pnt nearest_point(const Geom_Curve& curve, double first, double last, const gp_Pnt& x, double t,
                     double tolerance) {
  const ParameterRange range{first, last};
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
    for (int k = 0; k < kMostHalvings && moved > kRoundingFactor * tolerance; ++k, step /= 2)
      if (curve.Value(range.clamp(t + step)).SquareDistance(x) <= r.SquareMagnitude()) break;
    t = range.clamp(t + step);
    p = curve.Value(t);
    if (done) break;
  }
  return p;
}

using Elementary = std::variant<gp_Pln, gp_Cylinder, gp_Cone, gp_Sphere, gp_Torus>;

std::optional<Elementary> as_elementary(const Handle(Geom_Surface) & surface) {
  if (const auto s = Handle(Geom_Plane)::DownCast(surface); !s.IsNull()) return s->Pln();
  if (const auto s = Handle(Geom_CylindricalSurface)::DownCast(surface); !s.IsNull()) return s->Cylinder();
  if (const auto s = Handle(Geom_ConicalSurface)::DownCast(surface); !s.IsNull()) return s->Cone();
  if (const auto s = Handle(Geom_SphericalSurface)::DownCast(surface); !s.IsNull()) return s->Sphere();
  if (const auto s = Handle(Geom_ToroidalSurface)::DownCast(surface); !s.IsNull()) return s->Torus();
  return std::nullopt;
}

gp_Pnt pnt_of(const Vec3& p) { return {p.x, p.y, p.z}; }

/// Returns the curvatures; unknown if the tangents du and dv are parallel or vanish.
PrincipalCurvatures curvatures_of(const Geom_Surface& surface, double u, double v) {
  gp_Pnt p;
  gp_Vec du, dv, duu, dvv, duv;
  surface.D2(u, v, p, du, dv, duu, dvv, duv);
  const double e = du.Dot(du), f = du.Dot(dv), g = dv.Dot(dv), area2 = e * g - f * f;
  constexpr double kSingular = 1e-12;  // least squared sine between the tangents
  if (!(area2 > kSingular * e * g)) return {};
  const gp_Vec normal = du.Crossed(dv) / std::sqrt(area2);
  const double l = normal.Dot(duu), m = normal.Dot(duv), n = normal.Dot(dvv);
  const double mean = (e * n - 2 * f * m + g * l) / (2 * area2), gauss = (l * n - m * m) / area2;
  const double most = std::copysign(std::abs(mean) + std::sqrt(std::max(0.0, mean * mean - gauss)), mean);
  // The direction a du + b dv solves (l - most e) a + (m - most f) b = 0, and likewise for m and n.
  const double left = l - most * e, mixed = m - most * f, right = n - most * g;
  gp_Vec along = std::abs(left) * g > std::abs(right) * e ? left * dv - mixed * du : mixed * dv - right * du;
  if (along.Magnitude() == 0) along = du;
  along.Normalize();
  return {most, 2 * mean - most, {along.X(), along.Y(), along.Z()}};
}

/// Part of the parameters at the ends of a closed curve where both sides are tried.
constexpr double kNearEnd = 0.1;

class FaceProjector {
 public:
  explicit FaceProjector(FaceMesh face) : surface_(BRep_Tool::Surface(face.face)) {
    while (const auto trimmed = Handle(Geom_RectangularTrimmedSurface)::DownCast(surface_))
      surface_ = trimmed->BasisSurface();
    elementary_ = as_elementary(surface_);
    if (elementary_ || face.triangles.empty()) return;
    uv_ = std::move(face.uv);
    triangles_.emplace(std::move(face.points), std::move(face.triangles));
  }

  PrincipalCurvatures curvatures(const Vec3& x) const {
    const Vec2 uv = parameters(x);
    try {
      return curvatures_of(*surface_, uv.x, uv.y);
    } catch (const Standard_Failure&) {  // no second derivatives at this point
      return {};
    }
  }

  Vec3 nearest(const Vec3& x, double tolerance) const {
    const Vec2 uv = parameters(x);
    if (elementary_)
      return std::visit([&](const auto& surface) { return vec_of(ElSLib::Value(uv.x, uv.y, surface)); },
                        *elementary_);
    return vec_of(nearest_point(*surface_, pnt_of(x), uv.x, uv.y, tolerance));
  }

 private:
  /// Returns parameters of the nearest point: exact if it has a closed form, else by the nearest fine
  /// triangle.
  Vec2 parameters(const Vec3& x) const {
    Vec2 uv{0, 0};
    if (elementary_) {
      std::visit([&](const auto& surface) { ElSLib::Parameters(surface, pnt_of(x), uv.x, uv.y); },
                 *elementary_);
      return uv;
    }
    const NearestTriangle::Found found = triangles_->find(x);
    const auto& vertices = triangles_->triangle(found.triangle);
    for (int k = 0; k < 3; ++k) uv += found.weights[k] * uv_[vertices[k]];
    return uv;
  }

  Handle(Geom_Surface) surface_;
  std::optional<Elementary> elementary_;
  std::vector<Vec2> uv_;  ///< parameters of the triangles' points
  std::optional<NearestTriangle> triangles_;
};

class CurveProjector {
 public:
  explicit CurveProjector(const CurveMesh& mesh) : parameters_(mesh.parameters) {
    curve_ = BRep_Tool::Curve(mesh.edge, first_, last_);
    while (const auto trimmed = Handle(Geom_TrimmedCurve)::DownCast(curve_)) curve_ = trimmed->BasisCurve();
    is_closed_ = TopExp::FirstVertex(mesh.edge).IsSame(TopExp::LastVertex(mesh.edge));
    for (const double t : parameters_) points_.push_back(vec_of(curve_->Value(t)));
  }

  Vec3 nearest(const Vec3& x, double tolerance) const {
    double best2 = std::numeric_limits<double>::infinity(), best = first_;
    for (std::size_t k = 0; k + 1 < points_.size(); ++k) {
      const double t = nearest_part(x, points_[k], points_[k + 1]);
      const Vec3 away = points_[k] + t * (points_[k + 1] - points_[k]) - x;
      if (dot(away, away) >= best2) continue;
      best2 = dot(away, away);
      best = parameters_[k] + t * (parameters_[k + 1] - parameters_[k]);
    }
    const gp_Pnt target = pnt_of(x);
    const auto from = [&](double t) { return nearest_point(*curve_, first_, last_, target, t, tolerance); };
    const gp_Pnt p = from(best);
    // The nearest point may lie beyond the ends of a closed curve.
    if (!is_closed_ || std::min(best - first_, last_ - best) > kNearEnd * (last_ - first_)) return vec_of(p);
    const gp_Pnt q = from(best - first_ < last_ - best ? last_ : first_);
    return vec_of(q.SquareDistance(target) < p.SquareDistance(target) ? q : p);
  }

 private:
  Handle(Geom_Curve) curve_;
  double first_ = 0, last_ = 0;
  bool is_closed_ = false;
  std::vector<double> parameters_;
  std::vector<Vec3> points_;
};

class ShapeProjector : public SurfaceProjector {
 public:
  ShapeProjector(std::vector<FaceMesh> faces, const std::vector<CurveMesh>& curves, double tolerance)
      : tolerance_(tolerance) {
    for (FaceMesh& face : faces) faces_.emplace_back(std::move(face));
    for (const CurveMesh& curve : curves) curves_.emplace_back(curve);
  }
  Vec3 to_face(int face, const Vec3& x) const override {
    check_cancelled();
    return faces_[face].nearest(x, tolerance_);
  }
  Vec3 to_curve(int curve, const Vec3& x) const override {
    check_cancelled();
    return curves_[curve].nearest(x, tolerance_);
  }
  PrincipalCurvatures curvatures(int face, const Vec3& x) const override {
    return faces_[face].curvatures(x);
  }

 private:
  double tolerance_;
  std::vector<FaceProjector> faces_;
  std::vector<CurveProjector> curves_;
};

}  // namespace

std::shared_ptr<const SurfaceProjector> make_projector(std::vector<FaceMesh> faces,
                                                       const std::vector<CurveMesh>& curves,
                                                       double tolerance) {
  return std::make_shared<ShapeProjector>(std::move(faces), curves, tolerance);
}

}  // namespace delquad::cad
