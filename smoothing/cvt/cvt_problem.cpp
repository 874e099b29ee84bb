// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/cvt/cell_minimiser.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "smoothing/cvt/blocks.h"

namespace delquad {
namespace {

/// Returns the integral of 1/length^2, linear on triangles.
double squares_in(const TriPatch& tri, const std::vector<double>& length) {
  return sum_of_blocks(tri.triangles.size(), [&](std::size_t t) {
    const auto& v = tri.triangles[t];
    const double area = cross(tri.points[v[1]] - tri.points[v[0]], tri.points[v[2]] - tri.points[v[0]]) / 2;
    double sum = 0;
    for (const int i : v) sum += area / (3 * length[i] * length[i]);
    return sum;
  });
}

/// Returns the gradient of f around an inner point: the mean over its triangles by area, f linear on each.
Vec2 gradient_at(const MovingDelaunay& delaunay, int i, const std::vector<double>& f) {
  const std::vector<Vec2>& points = delaunay.patch().points;
  Vec2 sum;
  double twice = 0;
  for_each_corner(delaunay, i, [&](int t, int k) {
    const auto& v = delaunay.patch().triangles[t];
    const int a = v[(k + 1) % 3], b = v[(k + 2) % 3];
    const Vec2 to_a = points[a] - points[i], to_b = points[b] - points[i];
    twice += cross(to_a, to_b);
    sum += (f[b] - f[i]) * perp(to_a) - (f[a] - f[i]) * perp(to_b);
  });
  return (1 / twice) * sum;
}

}  // namespace

CvtProblem::CvtProblem(MovingDelaunay delaunay, int p) : delaunay_(std::move(delaunay)), energy_(p), p_(p) {}

void CvtProblem::hold_frames(const CrossField& cross, const ParametricSize& size) {
  const std::vector<Vec2>& points = delaunay_.patch().points;
  const std::size_t n = points.size();
  last_.reset();
  frames_ = {std::vector<Vec2>(n), std::vector<double>(n), std::vector<Vec2>(n), points};
  length_.resize(n);
  std::vector<double> log_weight(n);
  parallel_blocks(n, [&](std::size_t begin, std::size_t end) {
    int cross_hint = -1, size_hint = -1;  // one for each block, so that threads do not matter
    for (std::size_t i = begin; i < end; ++i) {
      const double theta = cross.at(points[i], cross_hint).angle();
      frames_.axis[i] = {std::cos(theta), std::sin(theta)};
      length_[i] = size.at(points[i], size_hint);
      log_weight[i] = -(p_ + 2) * std::log(length_[i]);
    }
  });
  squares_ = squares_in(delaunay_.patch(), length_);
  const std::size_t n_boundary = static_cast<std::size_t>(delaunay_.n_boundary());
  parallel_blocks(n, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      // Scaled here, not at the end, so that no power overflows.
      frames_.weight[i] =
          (p_ + 1) / (2 * squares_) * std::pow(2 / length_[i], p_) / (length_[i] * length_[i]);
      if (i >= n_boundary) frames_.slope[i] = gradient_at(delaunay_, static_cast<int>(i), log_weight);
    }
  });
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

std::span<const double> CvtProblem::lengths() const {
  return std::span(length_).subspan(delaunay_.n_boundary());
}

double CvtProblem::newton_scale() const {
  // For a fixed seed in a square cell of side delta', weight p (p - 1) times the integral of x^(p-2) is `2 p
  // (p + 1) / (N delta'^2)`.
  return squares_ / (2.0 * p_ * (p_ + 1));
}

double scaled_gradient_norm(const CvtProblem& problem) {
  double largest = 0;
  const auto g = problem.gradient();
  for (std::size_t i = 0; i < g.size(); ++i) largest = std::max(largest, problem.lengths()[i] * norm(g[i]));
  return largest * problem.newton_scale();
}

}  // namespace delquad
