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

/// Returns whether no triangle is flipped or flat, and the boundary neither crosses nor touches itself, by
/// exact predicates.
bool is_one_to_one(const Chart& chart, const std::vector<Vec2>& flat);

/// Returns the distortion of a map, which must be one-to-one.
FlatQuality measure_flat(const Chart& chart, const std::vector<Vec2>& flat);

/// A piece of a face with a one-to-one map to its parameter plane, positively oriented. The map keeps the
/// area of the piece, or of all pieces that embedded curves divide. Along embedded curves it is open by a
/// millionth of the lines.
struct FlatPatch {
  int face = -1;                   ///< index into Mesh::regions
  TriPatch flat;                   ///< boundary points first; two of them may be one point of the fine mesh
  std::vector<int> fine_node;      ///< fine point of each flat point
  std::vector<int> fine_triangle;  ///< fine triangle of each flat triangle
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
  double max_sigma = 1.3;           ///< patches with a larger FlatQuality::sigma_95 are divided
  std::vector<char> left_out = {};  ///< faces that get no patches, by region; empty: none
  /// Called after cuts were made. It may split lines, and returns pairs (split triangle, added half).
  std::function<std::vector<std::pair<int, int>>()> after_cuts = {};
  /// The element of each fine triangle. Cuts run along sides between elements, and split none. Empty: cuts
  /// run anywhere.
  std::vector<int> element = {};
  /// With `element`: whether cuts should avoid each fine point; empty: none.
  std::vector<char> avoided = {};
  /// Returns the length, by another metric, of the side between two fine points of a face; null: lengths in
  /// space.
  std::function<double(int face, int a, int b)> length = nullptr;
};

/// Returns conformal maps of all faces, as if there were no embedded curves (choice of maps and cuts own).
/// Faces that cannot be flattened, or only with much distortion, are cut. Cuts are added to the model as
/// curves, which refines the fine triangulation along them, and their ends as corners. The fine triangulation
/// should be improved before. Warnings of the model report cuts and failures. Throws as extract_charts().
Flattening flatten(SurfaceModel& model, const FlattenOptions& options = {});

}  // namespace delquad
