// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "delquad/fields.h"
#include "delquad/model.h"
#include "geometry/planar/planar_model.h"

// This header names the regions of line meshes. The preparation uses it.

namespace delquad {

/// Returns the domain that the lines of a mesh bound, its regions named as the file names surfaces. Names
/// come from the elements along a face's boundary, or else from the surface that the file lists with just
/// these curves. Else, for a single region, by the only surface group that has a name. A face with such a
/// surface is no hole. Named points without lines become nodes (see dangling_ends()) where there is a size,
/// else they are left out.
PlanarDomain make_named_domain(const Mesh& mesh, const DeclaredSurfaces& surfaces, const std::string& source,
                               const SizeField* size = nullptr);

/// Returns whether it has named points without lines.
bool has_single_points(const Mesh& mesh);

}  // namespace delquad
