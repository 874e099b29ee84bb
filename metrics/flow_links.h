// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "delquad/metrics.h"

// This header measures links of flow. `metrics --links` uses it.

namespace delquad {

/// Links of flow in a planar mesh, between centers of elements that share an edge. The measures follow
/// Delft3D FM (MeshKernel, MeshOrthogonality and Mesh2D::GetEdgesCrossingSmallFlowEdges). The center of a
/// triangle is its circumcenter. The center of a quad with at least two inner edges starts at the mean of its
/// corners. Each of 100 steps moves it a tenth of the way to the bisectors of inner edges. A center outside
/// returns towards the mean, up to the edge.
struct FlowLinks {
  int links = 0;
  /// |cos| of the angle between link and edge, 0 to 1, and 0 at a right angle; links without length do not
  /// count.
  double cos_max = 0, cos_mean = 0;
  int oblique = 0;     ///< links above 0.5, at which Delft3D FM stops
  int orthogonal = 0;  ///< links below 0.01, as its users want them
  Place worst;
  /// Links shorter than a tenth of the mean root of both areas, and the least ratio.
  int small = 0;
  double least_ratio = 0;
  Place shortest;
};
/// Returns the links of a planar mesh of triangles and quads.
FlowLinks measure_flow_links(const Mesh& mesh);

}  // namespace delquad
