#pragma once

#include <memory>
#include <string>
#include <vector>

#include "delquad/mesher.h"
#include "geometry/surface/triangulated_model.h"

namespace delquad {

/// The surface model of a problem with a TriangleModel, CadModel or ExampleModel, with its compounds. Throws
/// InputError for models that cannot be read, for options that have no effect on them, and for compounds of
/// faces that do not exist or do not hang together. `kept`: where features of triangles stay, and what is
/// small of any model. `cad`: what is read of a file of CAD, without compounds, is left there, and is not
/// read again.
SurfaceModel make_surface(const MeshProblem& problem, const std::vector<FeatureBall>& kept,
                          std::shared_ptr<const SurfaceModel>& cad);
SurfaceModel make_surface(const MeshProblem& problem);

}  // namespace delquad
