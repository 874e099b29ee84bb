#pragma once

#include "delquad/mesher.h"
#include "geometry/surface/surface_model.h"

namespace delquad {

/// Whether some triangle or quad does not lie in the plane of constant z of the first.
bool holds_surface(const Mesh& mesh);

/// The surface model of a problem with a TriangleModel, CadModel or ExampleModel, with its compounds. Throws
/// InputError for models that cannot be read, for options that have no effect on them, and for compounds of
/// faces that do not exist or do not hang together.
SurfaceModel make_surface(const MeshProblem& problem);

}  // namespace delquad
