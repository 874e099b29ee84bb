// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/box.h"
#include "delquad/mesh.h"
#include "delquad/metrics.h"
#include "geometry/surface/chart.h"
#include "geometry/surface/surface_model.h"

// This header maps faces to the plane. Most modules use it.

namespace delquad {

/// Returns whether no triangle is flipped or flat, and the boundary neither crosses nor touches itself:
/// exact.
bool is_one_to_one(const Chart& chart, const std::vector<Vec2>& flat);

/// Measures a map, which must be one-to-one.
FlatQuality measure_flat(const Chart& chart, const std::vector<Vec2>& flat);

/// A piece of a face laid flat, one-to-one and positively oriented. Its area is the area of the piece; pieces
/// that embedded curves divide have it together. Along embedded curves it is open by a millionth of the
/// lines.
struct FlatPatch {
  int face = -1;                   ///< index into Mesh::regions
  TriPatch flat;                   ///< boundary points first; two of them may be one point of the fine mesh
  std::vector<int> fine_node;      ///< of each flat point
  std::vector<int> fine_triangle;  ///< of each flat triangle
  /// Indices of flat points, the patch on the left; the longest loop first.
  std::vector<std::vector<int>> loops;
  FlatQuality quality;
  std::string method;                             ///< "plane", "boundary-first" or "spectral"
  std::vector<std::array<double, 3>> sides = {};  ///< see Chart::sides
};

/// Returns twice the area of a triangle of a patch: in space, or by its sides.
double double_area(const FlatPatch& patch, const Mesh& fine, std::size_t triangle);

struct Flattening {
  std::vector<FlatPatch> patches;  ///< by face, then by first triangle; a face may have several
  std::vector<SurfaceCut> cuts;
  std::vector<int> failed;  ///< faces of which some piece could not be flattened; they have no patches
  std::vector<Box<Vec3>> failed_at;  ///< box of the smallest such piece of each
};

struct FlattenOptions {
  double max_area_ratio = 10;       ///< patches with a larger FlatQuality::area_ratio are divided
  double max_sigma = 1.3;           ///< the same for sigma_95
  std::vector<char> left_out = {};  ///< faces that get no patches, by region; empty: none
  /// Called once cuts were made: may split lines, and returns pairs (triangle that was split, half that was
  /// added).
  std::function<std::vector<std::pair<int, int>>()> after_cuts = {};
  /// For each fine triangle the element that it is a part of. Cuts run along sides between elements, and
  /// split nothing. Empty: they run anywhere.
  std::vector<int> element = {};
  /// With `element`, of each fine point: cuts go there only for want of a way around; empty: no point is
  /// such.
  std::vector<char> avoided = {};
  /// The length of the side between two fine points, of a triangle of a face; null: in space.
  std::function<double(int face, int a, int b)> length = nullptr;
};

/// Flattens all faces conformally, as if there were no embedded curves. Faces that cannot be flattened as
/// they are, or only with much distortion, are cut. Cuts are added to the model as curves, which refines the
/// fine triangulation along them, and their ends as corners. The fine triangulation should have been improved
/// before. Cuts and failures are reported in the model's warnings. Throws InputError where sides of triangles
/// are on no curve but should be.
Flattening flatten(SurfaceModel& model, const FlattenOptions& options = {});

}  // namespace delquad
