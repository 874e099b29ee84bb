// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "delquad/mesh.h"

// This header moves points to the intersection of planes. Mid-surfaces use it.

namespace delquad {

/// Planes near a point, each at a distance along a normal of length 1.
class Planes {
 public:
  void add(const Vec3& normal, double distance) {
    const Eigen::Vector3d n(normal.x, normal.y, normal.z);
    directions_ += n * n.transpose();
    lengths_ += distance * n;
    sum_ = sum_ + distance * normal;
    longest_ = std::max(longest_, std::abs(distance));
    ++number_;
  }
  /// Returns the shortest shift onto all planes, as nearly as can be. Planes whose normals differ by less
  /// than 11 degrees count as one. At sharper folds it is the mean of the distances.
  Vec3 shift() const {
    /// Least eigenvalue of the directions, in parts of the largest.
    constexpr double kOtherDirection = 0.01;
    constexpr double kFarthest = 5;  // over the longest distance
    if (number_ == 0) return {};
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(directions_);
    Eigen::Vector3d all = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k)
      if (const double value = axes.eigenvalues()[k]; value > kOtherDirection * axes.eigenvalues()[2])
        all += axes.eigenvectors().col(k).dot(lengths_) / value * axes.eigenvectors().col(k);
    return all.norm() <= kFarthest * longest_ ? Vec3{all[0], all[1], all[2]} : (1.0 / number_) * sum_;
  }

 private:
  Eigen::Matrix3d directions_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d lengths_ = Eigen::Vector3d::Zero();
  Vec3 sum_ = {};
  double longest_ = 0;
  int number_ = 0;
};

}  // namespace delquad
