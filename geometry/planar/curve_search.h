#pragma once

#include <memory>
#include <span>
#include <vector>

#include "base/box_tree.h"
#include "delquad/model.h"

namespace delquad {

/// Finds parameters of a curve: of points on it, and between them by length.
class CurveSearch {
 public:
  /// `edges`: about how many edges of a mesh lie on the curve.
  CurveSearch(std::shared_ptr<const Curve> curve, int edges);

  struct Found {
    double t, distance;
  };
  /// The parameter of the point next to x.
  Found nearest(Vec2 x) const;
  /// Of a closed curve any parameter, of another one those nearest to [0, 1].
  Vec2 point(double t) const;
  /// The part of the curve between two points of it; of a closed curve the shorter one.
  struct Span {
    double from, to;  ///< of a closed curve perhaps beyond [0, 1]
    double off;       ///< how far the points are from the curve, the greater distance
  };
  Span between(Vec2 a, Vec2 b) const;
  /// Points at these parts of the length of a span, which ascend.
  std::vector<Vec2> at_parts(const Span& span, std::span<const double> parts) const;

 private:
  std::shared_ptr<const Curve> curve_;
  std::vector<double> t_;  ///< of the samples, ascending
  std::vector<Vec2> samples_;
  BoxTree<Vec2> chords_;
  bool closed_;
};

}  // namespace delquad
