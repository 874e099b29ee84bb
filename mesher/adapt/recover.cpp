// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/parallel_each.h"
#include "base/sort_unique.h"
#include "delquad/adapt.h"
#include "mesher/adapt/elements.h"

namespace delquad {
namespace {

constexpr int kFewestRings = 2, kMostRings = 6;
/// A degree is well determined if no diagonal entry of R is less than this part of the largest.
constexpr double kWellDetermined = 0.02;

/// Returns the mesh with points between regions repeated for each region.
Recovery recover_by_part(const Mesh& mesh, std::span<const double> values) {
  Recovery made;
  made.mesh = mesh;
  made.origin.resize(mesh.points.size());
  std::iota(made.origin.begin(), made.origin.end(), 0);
  made.values.assign(values.begin(), values.end());
  std::vector<std::vector<std::array<int, 2>>> known(mesh.points.size());  // region and point
  const auto take = [&](int& node, int region) {
    auto& sides = known[node];
    const auto at = std::ranges::find(sides, region, [](const auto& side) { return side[0]; });
    const int origin = node;
    if (at != sides.end()) {
      node = (*at)[1];
      return;
    }
    if (!sides.empty()) {
      node = static_cast<int>(made.origin.size());
      made.origin.push_back(origin);
      made.mesh.points.push_back(mesh.points[origin]);
      made.values.push_back(values[origin]);
    }
    sides.push_back({region, node});
  };
  for (std::size_t e = 0; e < mesh.triangles.size(); ++e)
    for (int& node : made.mesh.triangles[e]) take(node, mesh.triangle_region[e]);
  const std::size_t each = mesh.quads.empty() ? 0 : mesh.quad_nodes.size() / mesh.quads.size();
  for (std::size_t e = 0; e < mesh.quads.size(); ++e) {
    for (int& node : made.mesh.quads[e]) take(node, mesh.quad_region[e]);
    for (std::size_t k = 0; k < each; ++k) take(made.mesh.quad_nodes[e * each + k], mesh.quad_region[e]);
  }
  return made;
}

/// Rings of elements around points, as indices of their points.
class Rings {
 public:
  explicit Rings(const ElementMaps& elements) : elements_(elements), start_(elements.points().size() + 1, 0) {
    for (int e = 0; e < elements.size(); ++e)
      for (const int v : elements.nodes(e)) ++start_[v + 1];
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    at_.resize(start_.back());
    std::vector<int> next(start_.begin(), start_.end() - 1);
    for (int e = 0; e < elements.size(); ++e)
      for (const int v : elements.nodes(e)) at_[next[v]++] = e;
  }

  /// Adds the next ring; the patch is sorted. Returns whether there was one.
  bool grow(std::vector<int>& patch) const {
    const std::size_t before = patch.size();
    for (std::size_t i = 0; i < before; ++i)
      for (int k = start_[patch[i]]; k < start_[patch[i] + 1]; ++k)
        for (const int v : elements_.nodes(at_[k])) patch.push_back(v);
    sort_unique(patch);
    return patch.size() > before;
  }

 private:
  const ElementMaps& elements_;
  std::vector<int> start_, at_;
};

/// A polynomial around a point in the principal axes of its patch.
class Fit {
 public:
  /// `across` is the axis (0, 1) along which it is at most linear; -1: none.
  Fit(const std::vector<Vec3>& points, const std::vector<double>& values, int centre,
      const std::vector<int>& patch, int across)
      : across_(across) {
    const auto n = static_cast<Eigen::Index>(patch.size());
    Eigen::MatrixX2d offset(n, 2);
    values_.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Vec3 d = points[patch[i]] - points[centre];
      offset.row(i) << d.x, d.y;
      values_[i] = values[patch[i]] - values[centre];
    }
    Eigen::MatrixX2d spread = offset;
    if (across >= 0) spread.rowwise() -= offset.colwise().mean();  // else the axes of half a row are oblique
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(spread.transpose() * spread /
                                                              static_cast<double>(n));
    // Recomputed by the axes: the smaller eigenvalue has lost its digits if the patch is thin.
    placed_ = offset * axes.eigenvectors();
    for (int k = 0; k < 2; ++k) {
      const double scale = std::sqrt(placed_.col(k).squaredNorm() / static_cast<double>(n));
      to_axes_.row(k) = axes.eigenvectors().col(k).transpose() / scale;
      placed_.col(k) /= scale;
    }
  }

  /// Returns false if the points do not determine it.
  bool solve(int degree, Vec2& gradient, Tensor2& hessian) const {
    std::vector<std::array<int, 2>> powers;
    for (int sum = 0; sum <= degree; ++sum)
      for (int k = 0; k <= sum; ++k)
        if ((across_ != 0 || sum - k < 2) && (across_ != 1 || k < 2)) powers.push_back({sum - k, k});
    const auto terms = static_cast<Eigen::Index>(powers.size());
    if (values_.size() < terms || !to_axes_.allFinite()) return false;
    Eigen::MatrixXd matrix(values_.size(), terms);
    for (Eigen::Index t = 0; t < terms; ++t)
      matrix.col(t) = placed_.col(0).array().pow(powers[t][0]) * placed_.col(1).array().pow(powers[t][1]);
    const Eigen::VectorXd lengths = matrix.colwise().norm();
    if (!(lengths.minCoeff() > 0)) return false;
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(matrix * lengths.cwiseInverse().asDiagonal());
    const auto diagonal = qr.matrixR().diagonal().cwiseAbs();
    if (!(diagonal.minCoeff() >= kWellDetermined * diagonal.maxCoeff())) return false;
    const Eigen::VectorXd c = qr.solve(values_).cwiseQuotient(lengths);
    Eigen::Vector2d g(0, 0);
    Eigen::Matrix2d h = Eigen::Matrix2d::Zero();
    for (Eigen::Index t = 0; t < terms; ++t) {
      const auto [i, k] = powers[t];
      if (i + k == 1) g[k] = c[t];
      if (i + k == 2) h(i == 0, k > 0) += c[t], h(k > 0, i == 0) += c[t];
    }
    g = to_axes_.transpose() * g;
    h = to_axes_.transpose() * h * to_axes_;
    gradient = {g[0], g[1]};
    hessian = {h(0, 0), h(0, 1), h(1, 1)};
    return true;
  }

 private:
  int across_;
  Eigen::MatrixX2d placed_;
  Eigen::Matrix2d to_axes_;
  Eigen::VectorXd values_;
};

}  // namespace

Recovery recover(const Mesh& mesh, std::span<const double> values) {
  require_planar(mesh, "the mesh of the field");
  require_joined(mesh, "the mesh of the field");
  require_values(mesh, values, "that is to be recovered");
  Recovery made = recover_by_part(mesh, values);
  const std::size_t n = made.mesh.points.size();
  made.gradient.assign(n, {0, 0});
  made.hessian.assign(n, {0, 0, 0});
  const ElementMaps elements(made.mesh);
  const Rings rings(elements);
  parallel_each(n, [&](std::size_t i) {
    const int centre = static_cast<int>(i);
    const auto fits = [&](int degree, int across) {
      std::vector<int> patch{centre};
      const auto solve = [&] {
        return Fit(made.mesh.points, made.values, centre, patch, across)
            .solve(degree, made.gradient[i], made.hessian[i]);
      };
      for (int ring = 1; ring <= kMostRings && rings.grow(patch); ++ring)
        if (ring >= kFewestRings && solve()) return true;
      return solve();  // only one ring exists
    };
    for (int degree = mesh.order + 2; degree > 1; --degree)
      if (fits(degree, -1)) return;
    // A single row of elements has no more information across.
    for (int degree = mesh.order + 2; degree > 1; --degree)
      if (fits(degree, 0) || fits(degree, 1)) return;
    fits(1, -1);
  });
  return made;
}

}  // namespace delquad
