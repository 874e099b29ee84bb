#pragma once

#include <array>
#include <vector>

#include "delquad/fields.h"
#include "delquad/mesh.h"
#include "fields/background_mesh.h"

namespace delquad {

/// How a cross turns along a grid whose edges have the length delta.
///
/// A frame is that of a grid of squares of side delta exactly when it is parallel in the metric
/// |du|^2/delta^2: grad theta = J grad log delta, J turning by a quarter counterclockwise. Here log delta is
/// linear on each triangle of a background mesh.
class SizeConnection {
 public:
  SizeConnection(const TriPatch& tri, const ParametricSize& size);

  double log_size(int vertex) const { return log_size_[vertex]; }
  /// grad log delta in a triangle.
  Vec2 gradient(int t) const { return gradient_[t]; }
  /// By how much theta of a parallel cross turns along d, inside triangle t (radians).
  double turn(int t, Vec2 d) const { return cross(gradient_[t], d); }
  /// Turn of 4 theta from the triangle's centroid to the middles of its sides (opposite to each vertex).
  const std::vector<std::array<double, 3>>& phase_turns() const { return phase_turns_; }

 private:
  std::vector<double> log_size_;
  std::vector<Vec2> gradient_;
  std::vector<std::array<double, 3>> phase_turns_;
};

}  // namespace delquad
