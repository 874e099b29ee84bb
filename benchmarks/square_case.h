// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

#include "delquad/fields.h"
#include "delquad/model.h"
#include "features/curves/mesh_planar_curves.h"
#include "geometry/planar/planar_model.h"

/// This header has the domains of the microbenchmarks.
namespace delquad::benchmarks {

/// Uniform is the unit square. Graded is the domain and size field of Lewis [paper, section 6.4], scaled.
enum class Grading : int { kUniform, kGraded };

class SquareSize final : public ParametricSize, public SizeField {
 public:
  /// `elements` is the approximate number of triangles of D.
  SquareSize(Grading grading, double elements) : grading_(grading) {
    // Integral of 1/delta^2 at scale 1: two triangles for a square of side delta.
    constexpr double kUniformIntegral = 1, kLewisIntegral = 2567;
    scale_ = std::sqrt(2 * (grading == Grading::kUniform ? kUniformIntegral : kLewisIntegral) / elements);
  }
  double at(Vec2 u, int&) const override {
    if (grading_ == Grading::kUniform) return scale_;
    const double g = u.x - u.y * u.y;
    return 0.01 * scale_ * (1 + 30 * g * g + (1 - u.x) * (1 - u.x));
  }
  double at(const Vec3& x, int& hint) const override { return at(Vec2{x.x, x.y}, hint); }

 private:
  Grading grading_;
  double scale_;
};

/// Cross along the axes on the uniform square, along the parabolas x = y^2 on the graded one.
class SquareCross final : public CrossField {
 public:
  explicit SquareCross(Grading grading) : grading_(grading) {}
  Cross at(Vec2 u, int&) const override {
    return grading_ == Grading::kUniform ? Cross{} : Cross::from_angle(std::atan2(-2 * u.y, 1));
  }

 private:
  Grading grading_;
};

struct SquareCase {
  SquareCase(Grading grading, double elements) : size(grading, elements), cross(grading) {
    const Vec2 low = grading == Grading::kUniform ? Vec2{0, 0} : Vec2{-1.25, -0.5};
    const Vec2 high = grading == Grading::kUniform ? Vec2{1, 1} : Vec2{1.25, 1.25};
    PlanarModel model;
    model.curves.push_back({make_polyline({low, {high.x, low.y}, high, {low.x, high.y}, low}), "", ""});
    model.loops.push_back({{0}, "", ""});
    domain = make_domain(model, size);
  }
  const PatchBoundary& boundary() const { return domain.patches[0]; }

  SquareSize size;
  SquareCross cross;
  PlanarDomain domain;
};

}  // namespace delquad::benchmarks
