// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "delquad/fields.h"
#include "delquad/mesh.h"
#include "delquad/metrics.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/surface/flatten.h"
#include "geometry/surface/surface_model.h"

// This header compares meshes with their surface. The pipeline and soundness use it.

namespace delquad {

/// Measures SurfaceReport::near_cuts. `is_cut` tells, for each curve of the mesh, that it is no curve of the
/// model.
void measure_near_cuts(const Mesh& mesh, const std::vector<char>& is_cut, QuadShare& near, QuadShare& off);

Topology topology_of(const Mesh& mesh);
/// `sides` is sorted_half_edges() of the mesh.
Topology topology_of(const Mesh& mesh, std::span<const HalfEdge> sides);

/// Returns, by index of curve, whether more than two faces of a model meet there, or two with opposite
/// orientations.
std::vector<char> irregular_curves(const Mesh& fine);

MapReport report_maps(std::span<const FlatPatch* const> maps);

/// Compares a mesh with its model; the mesh has the model's curves and regions.
///
/// mesh_to_surface has samples at centers of elements and middles of edges. They are measured to the true
/// surface (for edges on curves to the curve), or to the triangles of a triangulated model. If nothing is
/// left out, these are the triangles before ignore_small(). surface_to_mesh has samples at points of the fine
/// triangulation, which lie on the surface. Triangles large enough to lie only in plane faces get more, 1/50
/// of the diagonal apart. They are measured to the elements, a quad as four triangles around its center.
/// `cuts` are curves added by flatten(), which belong to no true curve. `left_out` marks, by index, faces
/// without mesh, which do not count. `sides` is sorted_half_edges() of the mesh. `size` is delta, for
/// comparison with distances; it may be null. Points must be finite.
SurfaceReport report_surface(const SurfaceModel& model, std::span<const SurfaceCut> cuts,
                             const std::vector<char>& left_out, const Mesh& mesh,
                             std::span<const HalfEdge> sides, const SizeField* size);
SurfaceReport report_surface(const SurfaceModel& model, std::span<const SurfaceCut> cuts,
                             const std::vector<char>& left_out, const Mesh& mesh,
                             const SizeField* size = nullptr);

}  // namespace delquad
