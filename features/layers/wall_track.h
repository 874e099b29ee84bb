#pragma once

#include <memory>
#include <vector>

#include "delquad/model.h"

namespace delquad {

/// A chain of boundary edges between corners, on which nodes may be placed anew: on its curve, or on the
/// edges themselves where these were given.
class WallTrack {
 public:
  /// `params`: of the points on the curve; a null curve: the edges.
  WallTrack(std::vector<Vec2> points, std::shared_ptr<const Curve> curve, std::vector<double> params);

  int n_edges() const { return static_cast<int>(points_.size()) - 1; }
  double length() const { return length_.back(); }
  /// A place is an edge's number and the part of it: from 0 to n_edges(). By the length from the first point.
  double place(double length) const;
  Vec2 point(double place) const;
  /// On the curve.
  double param(double place) const;
  const std::shared_ptr<const Curve>& curve() const { return curve_; }

 private:
  static constexpr int kSamples = 16;  // an edge

  std::vector<Vec2> points_;
  std::shared_ptr<const Curve> curve_;
  std::vector<double> params_;
  std::vector<double> length_ = {0};  ///< up to each sample
};

}  // namespace delquad
