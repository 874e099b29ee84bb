#pragma once

#include <string>

#include "delquad/model.h"
#include "geometry/planar/planar_model.h"

namespace delquad {

/// The domain that the lines of a mesh bound, its regions named as the file names surfaces, where that is
/// plain: by the elements just inside of a loop; else by the surface that the file lists with just these
/// curves; else, for a single region, by the only surface group that has a name. A loop in a region that
/// holds such a surface is no hole.
PlanarDomain make_named_domain(const Mesh& mesh, const DeclaredSurfaces& surfaces, const std::string& source);

}  // namespace delquad
