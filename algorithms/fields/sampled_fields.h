// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "algorithms/fields/fields.h"
#include "base/box_tree.h"
#include "base/warning.h"
#include "delquad/mesh.h"

// This header samples expensive functions and interpolates between the samples. The pipeline, features and
// fields use it.

namespace delquad {

/// Rules for the samples of a function.
struct SampleRules {
  /// Numbers that the function gives for a point.
  int width = 1;
  /// Writes `width` numbers for each point, one point after the other.
  std::function<void(std::span<const Vec3> points, std::span<double> values)> function;
  /// Whether a point's numbers can be used.
  std::function<bool(const double* value)> is_good;
  /// By how much each of a point's numbers may be missed.
  std::function<double(const double* value)> tolerance;
  /// Edges of cells that are short enough there, whatever the tolerance says.
  std::function<double(const Vec3& at, const double* value)> short_edge;
};

/// Where a function is sampled.
struct SampleDomain {
  Box<Vec3> box;                  ///< around the model; may be flat
  const Mesh* surface = nullptr;  ///< its triangles, on and beside which samples lie; null: in all of the box
};

/// A function sampled on cells that are halved along all axes until it is linear along each axis of a cell.
/// Cells without extent along an axis, such as cells in the plane, have none there.
class SampleTree {
 public:
  /// The function is called in this thread, for all points of one generation of cells at once.
  SampleTree(const SampleDomain& domain, const SampleRules& rules);

  /// Writes what is interpolated at x, or at the point of the box nearest to it. Samples that are not good
  /// do not count. Null: written; else a sample that is not good, in the box, where all around x are not.
  struct Sample {
    Vec3 at;
    double value;  ///< the first of its numbers
  };
  std::optional<Sample> interpolate(const Vec3& x, std::span<double> value) const;

  std::span<const Vec3> points() const { return points_; }
  std::span<const double> values() const { return values_; }
  /// Returns whether there were more samples to take than are allowed.
  bool is_cut_short() const { return cut_short_; }

 private:
  static constexpr int kMostCorners = 8;
  /// Bit k of a corner's, and of a child's, number stands for the k-th axis: set on its upper side.
  struct Cell {
    std::array<int, kMostCorners> corner{};  ///< indices of samples
    int children = -1;                       ///< the first of them; -1: a leaf
  };
  class Builder;

  Sample bad_corner(const Cell& cell) const;

  Box<Vec3> box_;                   ///< as it was given
  int axes_ = 0;                    ///< along which the box has an extent
  std::array<int, 3> axis_{};       ///< those, by coordinate
  Vec3 low_;                        ///< of the box
  std::array<double, 3> extent_{};  ///< of the box, along axis_
  int width_;
  std::vector<Cell> cells_;
  std::vector<Vec3> points_;
  std::vector<double> values_;
  std::vector<char> good_;
  bool cut_short_ = false;
};

/// How far an interpolated size is off, as a part of the size: far below the spread of edge lengths in any
/// mesh.
inline constexpr double kSampledSizeError = 0.005;
/// How far cos 4 theta and sin 4 theta are off: a third of a degree.
inline constexpr double kSampledCrossError = 0.02;
/// Samples of a function lie no closer than this part of the size there: a mesh would not show more.
inline constexpr double kClosestSamples = 0.25;

/// Makes a field of a function. It is called here, on points in and beside the domain, and linear along the
/// axes between them. It may be further off than kSampledSizeError where values change within kClosestSamples
/// of the size, and where there would be too many samples. `warnings` tells of the latter. Throws InputError
/// if none of its values is a size. A bad value next to the domain does not count while others are nearer.
/// Messages call the function by `name`.
std::shared_ptr<const SizeField> sample_size(const SizeFunction& function, const SampleDomain& domain,
                                             const std::string& name, std::vector<Warning>& warnings);

/// Returns the same of an angle, on the plane of a flat domain. `size` says how close samples lie.
std::shared_ptr<const CrossField> sample_cross(const CrossFunction& function, const SampleDomain& domain,
                                               const SizeField& size, const std::string& name,
                                               std::vector<Warning>& warnings);

}  // namespace delquad
