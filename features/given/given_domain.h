// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "delquad/error.h"
#include "delquad/extend.h"
#include "geometry/planar/planar_model.h"

// This header makes a domain of a given planar mesh. The preparation uses it.

namespace delquad {

/// A planar mesh as a domain, with the elements of its patches.
struct GivenDomain {
  PlanarDomain domain;
  std::vector<QuadPatch> elements;  ///< of each patch, counterclockwise
  std::vector<Warning> warnings;
};

/// Returns the domain of a mesh in a plane of constant z. Lines, edges of one element and edges between
/// regions bound the patches, so they stay. Two edges at each named point inside stay, too. Throws
/// InputError, with places, for meshes that are not conforming. These have edges in more than two elements,
/// hanging nodes, elements with a corner twice, or outlines that cross.
GivenDomain make_given_domain(const GivenMesh& given);

/// Returns the side of a square with the area of the elements, averaged over two rings around each point; a
/// triangle is half a square.
std::vector<double> sizes_of_elements(const Mesh& mesh, const std::string& source);

/// Returns the mesh from which a pipeline begins: the elements in this form. For triangles quads are halved.
/// Throws InputError, with places, for triangles without a positive area, and for quads if there are none.
PatchMesh start_from(const QuadPatch& elements, PatchForm form);

}  // namespace delquad
