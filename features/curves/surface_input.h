#pragma once

#include <string>
#include <vector>

#include "delquad/mesher.h"
#include "geometry/surface/triangulated_model.h"

namespace delquad {

/// Refuses numbers out of range; `where` begins the message.
void check_surface(const SurfaceSpec& surface, const std::string& where);

/// The surface model of a problem with a TriangleModel, CadModel or ExampleModel, with its compounds. Throws
/// InputError for models that cannot be read, for options that have no effect on them, and for compounds of
/// faces that do not exist or do not hang together. `kept_features`: of triangles.
SurfaceModel make_surface(const MeshProblem& problem, const std::vector<FeatureBall>& kept_features = {});

}  // namespace delquad
