// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "geometry/surface/chart.h"

// This header has the cotangent Laplacian of a chart. Conformal maps and cuts use it.

namespace delquad {

/// Returns the cotangent of the angle at each corner of each triangle, bounded where a triangle has almost no
/// area.
std::vector<std::array<double, 3>> corner_cotangents(const Chart& chart);

/// Returns a third of the area of the triangles around each vertex.
std::vector<double> vertex_areas(const Chart& chart);

/// The cotangent Laplacian L of a chart (positive semi-definite), with factors for some fixed vertices.
class LaplaceSolver {
 public:
  /// Adds `shift` >= 0 times the vertex areas to the diagonal, which is necessary if no vertex is fixed.
  LaplaceSolver(const Chart& chart, std::vector<char> fixed, double shift = 0);

  /// Solves (L + shift areas) x = load at the free vertices, x = values at the fixed ones.
  std::vector<double> solve(const std::vector<double>& values, const std::vector<double>& load) const;
  /// Returns L x at every vertex.
  std::vector<double> apply(const std::vector<double>& x) const;

 private:
  struct System;
  std::shared_ptr<System> system_;
};

/// Returns the Fiedler function of the chart: its slowest vibration with free boundary, at each vertex. Its
/// level curves divide the chart where it is narrow, and meet the boundary at right angles.
std::vector<double> fiedler_function(const Chart& chart);

}  // namespace delquad
