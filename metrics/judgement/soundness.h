#pragma once

#include <span>
#include <string>

#include "delquad/mesher.h"
#include "geometry/mesh/half_edges.h"
#include "metrics/surface/surface_report.h"
#include "patches/prepared.h"

namespace delquad {

/// The middle of a quad, and its face.
Place middle_of_quad(const Mesh& mesh, int quad);
/// "face 3 at (1, 2, 3)".
std::string show_place(const Mesh& mesh, const Place& place);
/// `one`, or the number of places and `several`, and where the first are.
std::string describe(const Mesh& mesh, const Places& places, const std::string& one,
                     const std::string& several);

/// The first two of these, which are about single elements. Planar domains are seen from above.
Soundness check_elements(const PreparedProblem& prepared, const Mesh& mesh);

/// All of them, of a mesh with the curves and regions of its case. `report`: of surfaces, without the faces
/// that were left out; null of a mesh with points that are not finite. `sides`: the mesh's
/// sorted_half_edges().
Soundness check_soundness(const PreparedProblem& prepared, const Mesh& mesh, const SurfaceReport* report,
                          std::span<const HalfEdge> sides);

}  // namespace delquad
