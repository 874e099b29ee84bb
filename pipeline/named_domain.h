#pragma once

#include <string>

#include "geometry/planar_model.h"
#include "io/mesh_io.h"

namespace delquad {

/// The domain that the lines of a mesh bound, its regions named as the file names surfaces, where that is
/// plain: by the elements just inside of a loop; else by the surface that the file lists with just these
/// curves; else, for a single region, by the only surface group that has a name. A loop in a region that
/// holds such a surface is no hole.
PlanarDomain make_named_domain(const Mesh& mesh, const MshSurfaces& surfaces, const std::string& source);

}  // namespace delquad
