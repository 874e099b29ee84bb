#include "smoothing/cvt/cvt_problem.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace delquad {
namespace {

double area_of(const TriPatch& tri) {
  double twice = 0;
  for (const auto& v : tri.triangles)
    twice += cross(tri.points[v[1]] - tri.points[v[0]], tri.points[v[2]] - tri.points[v[0]]);
  return twice / 2;
}

}  // namespace

CvtProblem::CvtProblem(MovingDelaunay delaunay, int p)
    : delaunay_(std::move(delaunay)),
      energy_(p),
      p_(p),
      area_(area_of(delaunay_.patch())),
      spacing_(std::sqrt(area_ / delaunay_.n_points())) {}

void CvtProblem::hold_frames(const CrossField& cross, const ParametricSize& size) {
  const std::vector<Vec2>& points = delaunay_.patch().points;
  last_.reset();
  frames_.axis.resize(points.size());
  frames_.weight.resize(points.size());
  int cross_hint = -1, size_hint = -1;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double theta = cross.at(points[i], cross_hint).angle();
    frames_.axis[i] = {std::cos(theta), std::sin(theta)};
    // Scaled here, not at the end, so that no power overflows: (p + 1) / 2 (2 / delta)^p / area.
    frames_.weight[i] = (p_ + 1) / (2 * area_) * std::pow(2 / size.at(points[i], size_hint), p_);
  }
}

std::vector<Vec2> CvtProblem::seeds() const {
  const TriPatch& tri = delaunay_.patch();
  return {tri.points.begin() + tri.n_boundary, tri.points.end()};
}

std::optional<double> CvtProblem::evaluate(std::span<const Vec2> seeds) {
  const std::vector<Vec2>& points = delaunay_.patch().points;
  if (last_ && std::equal(seeds.begin(), seeds.end(), points.begin() + delaunay_.n_boundary())) return last_;
  last_.reset();
  if (!delaunay_.move_to(seeds) || !cells_.build(delaunay_)) return std::nullopt;
  const double energy = energy_.evaluate(delaunay_, cells_, frames_, gradient_);
  if (std::isfinite(energy)) last_ = energy;
  return last_;
}

std::span<const Vec2> CvtProblem::gradient() const {
  return std::span(gradient_).subspan(delaunay_.n_boundary());
}

double CvtProblem::newton_scale() const {
  // Of a seed in a square cell of side delta' that stays: weight p (p - 1) times the integral of x^(p-2) is
  // 2 p (p + 1) / area, whatever delta'.
  return area_ / (2.0 * p_ * (p_ + 1) * spacing_ * spacing_);
}

}  // namespace delquad
