// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <utility>
#include <vector>

#include "delquad/mesh.h"
#include "features/volume/skin.h"

// This header has directions and sizes of hexahedra inside a skin of quads. Points inside follow them.

namespace delquad {

/// Three orthogonal directions of unit length, right-handed, and the wanted length of edges along each.
struct Frame {
  std::array<Vec3, 3> axes;
  std::array<double, 3> sizes;
};

/// The coefficients of a frame's polynomial, then of the tensor of sizes.
using FrameValues = Eigen::Array<double, 21, 1>;

/// Frames and sizes: at the skin along normals and sides of quads, inside harmonic.
///
/// A frame is the polynomial of degree four that is the sum of (a.x)^4 over its axes a, which no permutation
/// of axes changes. Means of such polynomials are projected to the nearest frame, as crosses are in the
/// plane. The Laplace problem lives on the Delaunay tetrahedra of the skin's vertices and of points inside.
/// Sizes are a tensor; across a smooth skin its value comes from inside.
class FrameField {
 public:
  explicit FrameField(const Skin& skin);

  /// Returns the median of the sizes at the skin.
  double usual_size() const { return usual_size_; }
  const Frame& at_skin(int vertex) const { return frames_[vertex]; }
  /// Returns a tetrahedron at a vertex of the skin, for at().
  int cell_at_skin(int vertex) const { return cell_of_[vertex]; }
  /// Returns the frame at x, with axes near to the axes of `guess`. `cell` is a tetrahedron near x, and
  /// becomes the one around x; it becomes -1 outside of all.
  Frame at(const Vec3& x, const Frame& guess, int& cell) const;

 private:
  void make_cells();
  void fix_skin();
  void diffuse();
  void set_sizes(Frame& frame, const FrameValues& values) const;

  const Skin& skin_;
  int n_skin_;
  double usual_size_ = 0;
  std::vector<Vec3> points_;
  std::vector<std::array<int, 4>> cells_, neighbours_;
  std::vector<int> cell_of_;
  std::vector<std::vector<std::pair<int, double>>> beside_;  ///< by node, neighbors with weights
  std::vector<FrameValues> values_;
  std::vector<Frame> frames_;
  std::vector<std::array<double, 3>> known_;  ///< by vertex of the skin, sizes along its axes; 0: unknown
};

}  // namespace delquad
