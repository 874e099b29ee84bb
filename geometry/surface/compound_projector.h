#pragma once

#include <memory>
#include <vector>

#include "geometry/surface/surface_model.h"

namespace delquad {

/// The former faces (or curves) that each face (or curve) was made of, by index.
using EntityGroups = std::vector<std::vector<int>>;

EntityGroups each_alone(std::size_t n);

/// Projects to those of the faces that became one on whose fine triangles the nearest point lies, and to the
/// nearest of the curves. `fine`: the former triangulation, its regions the base's faces. Null for a null
/// base.
std::shared_ptr<const SurfaceProjector> make_compound_projector(std::shared_ptr<const SurfaceProjector> base,
                                                                const Mesh& fine, const EntityGroups& faces,
                                                                EntityGroups curves);

}  // namespace delquad
