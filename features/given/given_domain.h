// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "delquad/error.h"
#include "delquad/extend.h"
#include "geometry/planar/planar_model.h"

// This header makes a domain of a given planar mesh. The preparation uses it.

namespace delquad {

/// A planar mesh as a domain, and what its patches hold.
struct GivenDomain {
  PlanarDomain domain;
  std::vector<QuadPatch> elements;  ///< of each patch, counterclockwise
  std::vector<Warning> warnings;
};

/// Makes the domain. `given` is in a plane of constant z. Lines, edges of one element and edges between
/// regions bound the patches, so that they stay; so do two edges at a named point inside. Throws InputError,
/// naming places, for what is not conforming: edges in more than two elements, hanging nodes, elements with a
/// corner twice, outlines that cross.
GivenDomain make_given_domain(const GivenMesh& given);

/// Returns edge lengths of squares with the areas of the elements (triangles are half a square), meaned over
/// two rings around each point.
std::vector<double> sizes_of_elements(const Mesh& mesh, const std::string& source);

/// Returns the mesh from which a pipeline begins: the elements in this form, with halved quads if the form is
/// triangles. Throws InputError that names places: `triangles` need positive areas, and the form `quads`
/// needs quads.
PatchMesh start_from(const QuadPatch& elements, PatchForm form);

}  // namespace delquad
