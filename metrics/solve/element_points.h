#pragma once

#include <array>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// A point of a quadrature rule on an element, with its shape functions there.
struct ElementPoint {
  double weight;                 ///< times the area that it stands for
  Vec3 at;                       ///< on the element
  Vec3 normal;                   ///< of length 1
  std::array<double, 4> value;   ///< of each shape function
  std::array<Vec3, 4> gradient;  ///< of each, tangent to the element
};

/// Gauss's rule of `n` x `n` points, 2 or 3, on the bilinear quad through `corners`, in the plane or in space
/// [hughes2000, sections 3.2 and 3.8]. With its last two corners at one place it is a linear triangle, whose
/// shape functions 2 and 3 count together [hughes2000, section 3.6].
std::vector<ElementPoint> element_points(const std::array<Vec3, 4>& corners, int n);

}  // namespace delquad
