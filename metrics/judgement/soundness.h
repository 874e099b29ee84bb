// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>

#include "delquad/mesher.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/patches/meshing_setup.h"
#include "metrics/surface/surface_report.h"

// This header checks the soundness of meshes. The pipeline and the program use it.

namespace delquad {

/// Returns the middle of a quad, with its face.
Place middle_of_quad(const Mesh& mesh, int quad);
/// Returns "face 3 at (1, 2, 3)".
std::string show_place(const Mesh& mesh, const Place& place);
/// Returns `one`, or the number of places and `several`, with the first places.
std::string describe(const Mesh& mesh, const Places& places, const std::string& one,
                     const std::string& several);

/// Returns the result of the first two conditions of Soundness, for single elements. Planar domains are seen
/// from above.
Soundness check_elements(const MeshingSetup& prepared, const Mesh& mesh);

/// Returns the result of all conditions of Soundness, for a mesh with curves and regions of its case. On
/// surfaces `report` leaves out missing faces; it is null if a point is not finite. `sides` is
/// sorted_half_edges() of the mesh.
Soundness check_soundness(const MeshingSetup& prepared, const Mesh& mesh, const SurfaceReport* report,
                          std::span<const HalfEdge> sides);

}  // namespace delquad
