#include "geometry/cad/shape_projector.h"

#include <BRep_Tool.hxx>
#include <ElSLib.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Plane.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <variant>

#include "base/cancel.h"
#include "base/segment.h"
#include "geometry/cad/nearest_point.h"
#include "geometry/mesh/nearest_triangle.h"

namespace delquad::cad {

namespace {

using Elementary = std::variant<gp_Pln, gp_Cylinder, gp_Cone, gp_Sphere, gp_Torus>;

std::optional<Elementary> as_elementary(const Handle(Geom_Surface) & surface) {
  if (const auto s = Handle(Geom_Plane)::DownCast(surface); !s.IsNull()) return s->Pln();
  if (const auto s = Handle(Geom_CylindricalSurface)::DownCast(surface); !s.IsNull()) return s->Cylinder();
  if (const auto s = Handle(Geom_ConicalSurface)::DownCast(surface); !s.IsNull()) return s->Cone();
  if (const auto s = Handle(Geom_SphericalSurface)::DownCast(surface); !s.IsNull()) return s->Sphere();
  if (const auto s = Handle(Geom_ToroidalSurface)::DownCast(surface); !s.IsNull()) return s->Torus();
  return std::nullopt;
}

Vec3 vec_of(const gp_Pnt& p) { return {p.X(), p.Y(), p.Z()}; }
gp_Pnt pnt_of(const Vec3& p) { return {p.x, p.y, p.z}; }

/// The larger of the principal curvatures by size; NaN where the tangents du and dv are parallel or vanish.
double largest_curvature(const Geom_Surface& surface, double u, double v) {
  gp_Pnt p;
  gp_Vec du, dv, duu, dvv, duv;
  surface.D2(u, v, p, du, dv, duu, dvv, duv);
  const double e = du.Dot(du), f = du.Dot(dv), g = dv.Dot(dv), area2 = e * g - f * f;
  constexpr double kSingular = 1e-12;  // of the squared sine between the tangents
  if (!(area2 > kSingular * e * g)) return std::numeric_limits<double>::quiet_NaN();
  const gp_Vec normal = du.Crossed(dv) / std::sqrt(area2);
  const double l = normal.Dot(duu), m = normal.Dot(duv), n = normal.Dot(dvv);
  const double mean = (e * n - 2 * f * m + g * l) / (2 * area2), gauss = (l * n - m * m) / area2;
  return std::abs(mean) + std::sqrt(std::max(0.0, mean * mean - gauss));
}

/// How near to the ends of a closed curve both sides are tried, as a fraction of its parameters.
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

  double curvature(const Vec3& x) const {
    const Vec2 uv = parameters(x);
    try {
      return largest_curvature(*surface_, uv.x, uv.y);
    } catch (const Standard_Failure&) {  // no second derivatives there
      return std::numeric_limits<double>::quiet_NaN();
    }
  }

  Vec3 nearest(const Vec3& x, double tolerance) const {
    if (elementary_) {
      return std::visit(
          [&](const auto& surface) {
            double u, v;
            ElSLib::Parameters(surface, pnt_of(x), u, v);
            return vec_of(ElSLib::Value(u, v, surface));
          },
          *elementary_);
    }
    const Vec2 uv = parameters(x);
    return vec_of(nearest_point(*surface_, pnt_of(x), uv.x, uv.y, tolerance));
  }

 private:
  /// Exact where the nearest point has a closed form, else those of the nearest fine triangle.
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
  std::vector<Vec2> uv_;  ///< of the triangles' points
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
    // The nearest point may lie across the point where a closed curve begins and ends.
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
  double face_curvature(int face, const Vec3& x) const override { return faces_[face].curvature(x); }

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
