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

/// Returns the topology of a mesh.
Topology topology_of(const Mesh& mesh);
/// `sides` is sorted_half_edges() of the mesh.
Topology topology_of(const Mesh& mesh, std::span<const HalfEdge> sides);

/// Returns, by index of curve, whether more than two faces of a model meet there, or two with opposite
/// orientations.
std::vector<char> irregular_curves(const Mesh& fine);

/// Returns the distance of maps from conformal ones.
MapReport report_maps(std::span<const FlatPatch* const> maps);

/// Returns the comparison of a mesh with its model; the mesh has the model's curves and regions. Own method.
SurfaceReport report_surface(const SurfaceModel& model, std::span<const SurfaceCut> cuts,
                             const std::vector<char>& left_out, const Mesh& mesh,
                             std::span<const HalfEdge> sides, const SizeField* size);
SurfaceReport report_surface(const SurfaceModel& model, std::span<const SurfaceCut> cuts,
                             const std::vector<char>& left_out, const Mesh& mesh,
                             const SizeField* size = nullptr);

}  // namespace delquad
