#pragma once

#include "delquad/metrics.h"

namespace delquad {

/// Links of flow of a planar mesh, between the centres of two elements that share an edge, as Delft3D FM
/// measures them (MeshKernel, MeshOrthogonality and Mesh2D::GetEdgesCrossingSmallFlowEdges). The centre of a
/// triangle is that of its circle. The centre of a quad begins at the mean of its corners and goes a tenth of
/// the way to the lines that halve its inner edges at right angles, a hundred times, where there are two such
/// edges at least. Centres outside go back towards the mean, to the edge.
struct FlowLinks {
  int links = 0;
  /// |cos| of the angle between link and edge, 0 where they are at right angles; links of no length have
  /// none.
  double cos_max = 0, cos_mean = 0;
  int oblique = 0;     ///< links with more than 0.5, for which Delft3D FM stops
  int orthogonal = 0;  ///< links with less than 0.01, as its users want them
  Place worst;
  /// Links that are shorter than a tenth of the mean of the roots of both areas, and the least of these
  /// ratios.
  int small = 0;
  double least_ratio = 0;
  Place shortest;
};
FlowLinks measure_flow_links(const Mesh& mesh);

}  // namespace delquad
