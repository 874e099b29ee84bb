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
  /// Count of numbers that the function gives for a point, >= 1.
  int width = 1;
  /// Writes `width` numbers for each point, one point after the other.
  std::function<void(std::span<const Vec3> points, std::span<double> values)> function;
  /// Returns whether a point's numbers can be used.
  std::function<bool(const double* value)> is_good;
  /// Returns the largest error of each number of a point.
  std::function<double(const double* value)> tolerance;
  /// Returns the length of edges of cells that are not halved, whatever the tolerance.
  std::function<double(const Vec3& at, const double* value)> short_edge;
};

/// Domain in which a function is sampled.
struct SampleDomain {
  Box<Vec3> box;                  ///< around the model; may be flat
  const Mesh* surface = nullptr;  ///< samples lie on and beside it; null: in the whole box
};

/// A function sampled on cells that are halved along all axes until it is linear along each axis of a cell
/// (own method). Axes along which the box is flat do not count.
class SampleTree {
 public:
  /// Calls the function in this thread, for all points of one generation of cells at once.
  SampleTree(const SampleDomain& domain, const SampleRules& rules);

  /// A sample that is not good.
  struct Sample {
    Vec3 at;
    double value;  ///< the first of its numbers
  };
  /// Writes `width` numbers, interpolated from the good samples at x, or at the point of the box nearest to
  /// it. Returns nothing then; or, if no sample around x is good, one of these.
  std::optional<Sample> interpolate(const Vec3& x, std::span<double> value) const;

  std::span<const Vec3> points() const { return points_; }
  std::span<const double> values() const { return values_; }
  /// Returns whether the limit of four million samples was reached.
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

/// Error of an interpolated size, as a part of the size: far below the spread of edge lengths in any mesh.
inline constexpr double kSampledSizeError = 0.005;
/// Error of interpolated cos 4 theta and sin 4 theta: a third of a degree.
inline constexpr double kSampledCrossError = 0.02;
/// Least distance of samples, as a part of the size there: a mesh would not show more.
inline constexpr double kClosestSamples = 0.25;

/// Returns a field that interpolates a function, which is called here only, on points in and beside the
/// domain. The error may exceed kSampledSizeError where values change within kClosestSamples of the size. It
/// may also do so at the limit of samples, with a warning. Throws InputError if none of its values is a size;
/// the field throws it at points with bad values only around. Messages call the function by `name`.
std::shared_ptr<const SizeField> sample_size(const SizeFunction& function, const SampleDomain& domain,
                                             const std::string& name, std::vector<Warning>& warnings);

/// Returns the same for an angle (radians) in the plane of a flat domain. `size` tells how close samples lie.
std::shared_ptr<const CrossField> sample_cross(const CrossFunction& function, const SampleDomain& domain,
                                               const SizeField& size, const std::string& name,
                                               std::vector<Warning>& warnings);

}  // namespace delquad
