// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "delquad/fields.h"
#include "delquad/model.h"
#include "geometry/planar/planar_model.h"

// This header names the regions of line meshes. The preparation uses it.

namespace delquad {

/// Returns the domain that the lines of a mesh bound, with regions named as the surfaces of the file. A
/// region takes names from the elements along its boundary, or else from the declared surface with exactly
/// these curves. Otherwise a single region takes the name of the only named group. A face with such a surface
/// is no hole. Named points without lines become nodes (see dangling_ends()) if there is a `size`; null: they
/// are left out. Throws InputError as build_domain() and dangling_ends(), beginning with `source`.
PlanarDomain make_named_domain(const Mesh& mesh, const DeclaredSurfaces& surfaces, const std::string& source,
                               const SizeField* size = nullptr);

/// Returns whether a mesh has named points without lines.
bool has_single_points(const Mesh& mesh);

}  // namespace delquad
