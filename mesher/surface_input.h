#pragma once

#include "delquad/mesher.h"
#include "geometry/surface/triangulated_model.h"

namespace delquad {

/// Whether some triangle or quad does not lie in the plane of constant z of the first.
bool holds_surface(const Mesh& mesh);

/// The surface model of a problem with a TriangleModel, CadModel or ExampleModel, with its compounds. Throws
/// InputError for models that cannot be read, for options that have no effect on them, and for compounds of
/// faces that do not exist or do not hang together. `kept_features`: of triangles.
SurfaceModel make_surface(const MeshProblem& problem, const std::vector<FeatureBall>& kept_features = {});

}  // namespace delquad
