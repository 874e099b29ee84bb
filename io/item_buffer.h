// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "delquad/mesh.h"

// This header finds the nearest triangle at each sample of a raster. Readers and writers use it.

namespace delquad {

/// Finds the nearest of many triangles at each sample of a raster. Triangles have x, y in samples and a depth
/// z; larger is nearer.
class ItemBuffer {
 public:
  static constexpr double kNothing = -std::numeric_limits<double>::infinity();

  ItemBuffer(int width, int height)
      : width_(std::max(width, 1)),
        height_(std::max(height, 1)),
        depth_(static_cast<size_t>(width_) * height_, kNothing),
        item_(depth_.size(), -1) {}

  void add(int item, const std::array<Vec3, 3>& triangle) {
    for_each_sample(triangle, [&](size_t at, double depth) {
      if (depth <= depth_[at]) return;
      depth_[at] = depth;
      item_[at] = item;
    });
  }

  /// Calls visit(index of the sample, depth) for the samples inside a triangle and on its edges.
  template <class Visit>
  void for_each_sample(const std::array<Vec3, 3>& triangle, Visit visit) const {
    const auto& [a, b, c] = triangle;
    const double twice_area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if (twice_area == 0) return;
    const int x0 = std::max(0, static_cast<int>(std::ceil(std::min({a.x, b.x, c.x}))));
    const int x1 = std::min(width_ - 1, static_cast<int>(std::floor(std::max({a.x, b.x, c.x}))));
    const int y0 = std::max(0, static_cast<int>(std::ceil(std::min({a.y, b.y, c.y}))));
    const int y1 = std::min(height_ - 1, static_cast<int>(std::floor(std::max({a.y, b.y, c.y}))));
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const double v = ((x - a.x) * (c.y - a.y) - (y - a.y) * (c.x - a.x)) / twice_area;
        const double w = ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)) / twice_area;
        if (v < 0 || w < 0 || v + w > 1) continue;
        visit(static_cast<size_t>(y) * width_ + x, a.z + v * (b.z - a.z) + w * (c.z - a.z));
      }
    }
  }

  double depth(size_t sample) const { return depth_[sample]; }
  /// Returns for each sample the item; -1: none.
  const std::vector<int>& items() const { return item_; }

  /// Returns the least depth of the 3 x 3 samples around a point; things behind it are hidden.
  double depth_around(double x, double y) const {
    double least = std::numeric_limits<double>::infinity();
    const int cx = static_cast<int>(std::lround(x)), cy = static_cast<int>(std::lround(y));
    for (int j = std::max(cy - 1, 0); j <= std::min(cy + 1, height_ - 1); ++j) {
      for (int i = std::max(cx - 1, 0); i <= std::min(cx + 1, width_ - 1); ++i) {
        least = std::min(least, depth_[static_cast<size_t>(j) * width_ + i]);
      }
    }
    return least;
  }

 private:
  int width_, height_;
  std::vector<double> depth_;
  std::vector<int> item_;
};

}  // namespace delquad
