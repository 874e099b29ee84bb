#pragma once

#include <span>
#include <vector>

#include "delquad/fields.h"
#include "delquad/mesh.h"
#include "delquad/metrics.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/surface/flatten.h"
#include "geometry/surface/surface_model.h"

namespace delquad {

/// See SurfaceReport::near_cuts. `is_cut`: of each curve of the mesh, whether it is no curve of the model.
void measure_near_cuts(const Mesh& mesh, const std::vector<char>& is_cut, QuadShare& near, QuadShare& off);

Topology topology_of(const Mesh& mesh);
/// `sides`: of sorted_half_edges().
Topology topology_of(const Mesh& mesh, std::span<const HalfEdge> sides);

/// By curve (index), whether more than two faces of a model meet there, or two that are turned against each
/// other.
std::vector<char> irregular_curves(const Mesh& fine);

MapReport report_maps(std::span<const FlatPatch* const> maps);

/// Compares a mesh with its model; the mesh has the model's curves and regions.
///
/// mesh_to_surface is sampled at the centre of each element and the middle of each edge, against the true
/// surface (the curve, for edges on curves), or against the triangles of a triangulated model, as they were
/// before ignore_small() where nothing is left out.
/// surface_to_mesh is sampled at the points of the fine triangulation, which lie on the surface, and inside
/// triangles so large that only plane faces have them, a 50th of the diagonal apart; against the elements, a
/// quad being four triangles around its centre. `cuts`: curves that
/// flatten() added, which belong to no true curve. `left_out`: faces, by index, that were not meshed; they do
/// not count. `sides`: the mesh's sorted_half_edges(). `size`: delta, that distances are compared with; may
/// be null. Points must be finite.
SurfaceReport report_surface(const SurfaceModel& model, std::span<const SurfaceCut> cuts,
                             const std::vector<char>& left_out, const Mesh& mesh,
                             std::span<const HalfEdge> sides, const SizeField* size);
SurfaceReport report_surface(const SurfaceModel& model, std::span<const SurfaceCut> cuts,
                             const std::vector<char>& left_out, const Mesh& mesh,
                             const SizeField* size = nullptr);

}  // namespace delquad
