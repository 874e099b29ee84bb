// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/mesh_by_outline.h"

#include <algorithm>
#include <cmath>
#include <gp_Pnt.hxx>
#include <gp_Vec.hxx>

#include "base/box.h"
#include "base/cancel.h"
#include "geometry/mesh/delaunay_kernel.h"

namespace delquad::cad {

namespace {

struct SurfacePoint {
  Vec3 point, normal;  ///< unit normal, or 0 if there is none
};

SurfacePoint evaluate(const Geom_Surface& surface, Vec2 uv) {
  gp_Pnt p;
  gp_Vec du, dv;
  surface.D1(uv.x, uv.y, p, du, dv);
  const gp_Vec normal = du.Crossed(dv);
  const double length = normal.Magnitude();
  constexpr double kParallel = 1e-9;  // sine between the tangents
  if (!(length > kParallel * du.Magnitude() * dv.Magnitude())) return {vec_of(p), {0, 0, 0}};
  return {vec_of(p), {normal.X() / length, normal.Y() / length, normal.Z() / length}};
}

class FaceRefiner {
 public:
  FaceRefiner(const Geom_Surface& surface, const TriPatch& start, std::vector<Vec3> points, Vec2 scale,
              const FaceBounds& bounds)
      : surface_(surface),
        scale_(scale),
        bounds_(bounds),
        cosine_(std::cos(bounds.angle)),
        kernel_(start),
        n_boundary_(static_cast<int>(points.size())),
        points_(std::move(points)) {
    for (const Vec2 x : start.points) normals_.push_back(evaluate(surface_, parameters(x)).normal);
  }

  RefinedFace refine() {
    std::vector<int> waiting;
    for (int t = 0; t < std::ssize(kernel_.triangles()); ++t) waiting.push_back(t);
    bool is_complete = true;
    // In order of arrival, so that points spread evenly if their number is limited.
    for (std::size_t i = 0; i < waiting.size(); ++i) {
      check_cancelled();
      const Refinement refinement = worst_of(waiting[i]);
      if (!refinement.is_wanted) continue;
      if (std::ssize(points_) - n_boundary_ >= bounds_.most_points) {
        is_complete = false;
        break;
      }
      if (!kernel_.find_cavity(refinement.at, waiting[i])) continue;
      const SurfacePoint on = evaluate(surface_, parameters(refinement.at));
      points_.push_back(on.point);
      normals_.push_back(on.normal);
      const std::span<const int> star = kernel_.insert(refinement.at);
      waiting.insert(waiting.end(), star.begin(), star.end());
    }
    return {kernel_.to_patch(n_boundary_), std::move(points_), is_complete};
  }

 private:
  struct Refinement {
    bool is_wanted = false;
    Vec2 at{0, 0};
  };

  Vec2 parameters(Vec2 x) const { return {x.x / scale_.x, x.y / scale_.y}; }

  /// Returns the distance, across the surface, from a point of a chord to the surface at the same parameters.
  double deviation(Vec2 x, const Vec3& chord) const {
    const SurfacePoint on = evaluate(surface_, parameters(x));
    return std::abs(dot(on.normal, on.point - chord));
  }

  /// Returns the longest inner side that turns or deviates too much; else the middle of the triangle if it
  /// does.
  Refinement worst_of(int t) const {
    const DelaunayKernel::Triangle& triangle = kernel_.triangles()[t];
    const std::vector<Vec2>& x = kernel_.points();
    Refinement refinement;
    double longest = bounds_.deflection;
    for (int k = 0; k < 3; ++k) {
      const int a = triangle.v[(k + 1) % 3], b = triangle.v[(k + 2) % 3];
      const double length = norm(points_[b] - points_[a]);
      if (triangle.n[k] < 0 || length <= longest) continue;
      const Vec2 middle = 0.5 * (x[a] + x[b]);
      if (!turns(a, b) && deviation(middle, 0.5 * (points_[a] + points_[b])) <= bounds_.deflection) continue;
      longest = length;
      refinement = {true, middle};
    }
    if (refinement.is_wanted) return refinement;
    const auto [a, b, c] = triangle.v;
    const Vec2 middle = (1.0 / 3) * (x[a] + x[b] + x[c]);
    const double size = std::sqrt(norm(cross(points_[b] - points_[a], points_[c] - points_[a])));
    if (size <= bounds_.deflection) return refinement;
    return {deviation(middle, (1.0 / 3) * (points_[a] + points_[b] + points_[c])) > bounds_.deflection,
            middle};
  }

  bool turns(int a, int b) const {
    const Vec3 &m = normals_[a], &n = normals_[b];
    return dot(m, m) > 0 && dot(n, n) > 0 && dot(m, n) < cosine_;
  }

  const Geom_Surface& surface_;
  Vec2 scale_;
  FaceBounds bounds_;
  double cosine_;
  DelaunayKernel kernel_;
  int n_boundary_;
  std::vector<Vec3> points_, normals_;  ///< places and normals of the points
};

}  // namespace

RefinedFace refine_face(const Geom_Surface& surface, const TriPatch& start, std::vector<Vec3> points,
                        Vec2 scale, const FaceBounds& bounds) {
  return FaceRefiner(surface, start, std::move(points), scale, bounds).refine();
}

Vec2 parameter_scale(const Geom_Surface& surface, const std::vector<Vec2>& uv) {
  const auto [low, high] = Box<Vec2>::around(std::span(uv));
  // Samples an even grid in the box, since the outline of a band around a pole tells too little.
  constexpr int kSamples = 8;
  double u_speed = 0, v_speed = 0;
  for (int i = 0; i < kSamples; ++i) {
    for (int j = 0; j < kSamples; ++j) {
      gp_Pnt p;
      gp_Vec du, dv;
      surface.D1(low.x + (high.x - low.x) * (i + 0.5) / kSamples,
                 low.y + (high.y - low.y) * (j + 0.5) / kSamples, p, du, dv);
      u_speed += du.Magnitude() / (kSamples * kSamples);
      v_speed += dv.Magnitude() / (kSamples * kSamples);
    }
  }
  const auto usable = [](double speed) { return std::isfinite(speed) && speed > 0; };
  if (!usable(u_speed) || !usable(v_speed)) return {1, 1};
  return {u_speed, v_speed};
}

}  // namespace delquad::cad
