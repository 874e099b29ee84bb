// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Dense>
#include <array>
#include <utility>
#include <vector>

#include "base/box_tree.h"
#include "delquad/mesh.h"
#include "features/volume/body_parts.h"
#include "geometry/mesh/nearest_triangle.h"

// This header has the steps that place hexahedra in a skin, in their order. The filling of volumes uses it.

namespace delquad {

/// A closed surface of quads, counterclockwise seen from outside; each quad is two triangles.
class Skin {
 public:
  /// Throws std::invalid_argument without quads.
  explicit Skin(const Mesh& body);

  /// The body with the quads, whose points are corners of these.
  const Mesh& body() const { return body_; }

  /// Returns whether x lies inside: whether a ray from x crosses the skin an odd number of times.
  bool contains(const Vec3& x) const;
  /// Returns the distance from x to the skin if it is within `reach`, otherwise infinity.
  double distance(const Vec3& x, double reach) const { return nearest_.find(x, reach).distance; }

 private:
  const Mesh& body_;
  std::vector<std::array<Vec3, 3>> corners_;
  NearestTriangle nearest_;
  BoxTree<Vec3> tree_;
};

using Axes = std::array<Vec3, 3>;
/// Three orthogonal directions of unit length, right-handed, and the wanted length of edges along each.
struct Frame {
  Axes axes;
  std::array<double, 3> sizes;
};

/// A frame's polynomial of degree four by products of two coordinates, and the tensor of sizes.
using FrameValues = Eigen::Matrix<double, 6, 7>;
/// Gives values the polynomial of axes.
void set_axes(FrameValues& values, const Axes& axes);

/// Calls f(v, w) for the sides of all quads, in both directions.
template <class F>
void for_each_side(const Mesh& skin, const F& f) {
  for (const Quad& q : skin.quads)
    for (int k = 0; k < 4; ++k) f(q[k], q[(k + 1) % 4]), f(q[(k + 1) % 4], q[k]);
}

/// Frames and sizes at the skin, along normals and sides of quads.
/// A frame is the polynomial of degree four that is the sum of (a.x)^4 over its axes a, which no permutation
/// of axes changes. Means of such polynomials are projected to the nearest frame, as crosses are in the
/// plane. Sizes are a tensor; across a smooth skin its value comes from inside.
struct SkinFrames {
  explicit SkinFrames(const Mesh& skin);

  /// Gives values at a vertex the known sizes along its axes.
  void keep_known_sizes(FrameValues& at, int vertex) const;
  /// Returns the frame of values, with axes near a guess.
  Frame frame_of(const FrameValues& at, const Axes& guess) const;

  double usual_size;  ///< median
  std::vector<FrameValues> values;
  std::vector<Frame> frames;
  std::vector<std::array<double, 3>> known;  ///< by vertex, sizes along its axes; 0: unknown
};

/// Points with their neighbors along the directions of frames.
struct Lattice {
  std::vector<Vec3> points;  ///< the vertices of the skin first
  /// By point, ascending, the best neighbors along the directions, and all that may serve. Both lists have
  /// the sides of quads.
  std::vector<std::vector<int>> best, beside;
};

/// Neighbors that points of a lattice want.
enum class Packing {
  kCubes,  ///< six, one size along the axes of the frame; the L-infinity norm
  /// Twelve of equilateral tetrahedra and octahedra, whose squares lie across the third axis, which is the
  /// normal at the skin; the Euclidean norm.
  kTetrahedra,
};

/// Returns a lattice inside of the skin that follows frames. They are harmonic between the frames of the
/// skin.
/// A front starts at the skin, as the front of squares in the plane [remacle2013]. Each point proposes a
/// point at one size along each direction of the packing. It is kept if no other is too near in the norm of
/// its frame. Then points move to where their neighbors want them, crowded points go, and the front fills
/// gaps again.
Lattice fill_with_points(const Skin& skin, Packing packing);

using Hexahedron = std::array<int, 8>;

/// Returns hexahedra between points whose twelve edges join points that lie `beside` each other. Each is
/// there once. They meet the skin only in its vertices, edges and quads.
std::vector<Hexahedron> find_hexahedra(const std::vector<Vec3>& points,
                                       const std::vector<std::vector<int>>& beside, const Skin& skin);

/// Chooses hexahedra for a body. Two of them share nothing, a vertex, an edge or a side, and do not overlap.
/// The choice runs greedily by volume, then exchanges while the volume and the number of shared sides grow.
void select_hexahedra(Mesh& body, const std::vector<Hexahedron>& candidates);

/// Removes hexahedra until the sides that bound the rest of the body do not cross, with either diagonal
/// (exact).
void separate_sides(Mesh& body);

}  // namespace delquad
