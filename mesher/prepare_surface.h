#pragma once

#include <functional>

#include "features/given/given_surface.h"
#include "geometry/surface/surface_model.h"
#include "mesher/prepare.h"

namespace delquad {

/// Of a model whose loose lines are imprinted: faces flattened, curves meshed once each, all patches even;
/// cross field and size on each patch. Refuses sizes that would need more than problem.max_elements through
/// `check_count`. Throws InputError naming faces that cannot be meshed, unless problem.keep_going leaves them
/// out and others remain.
PreparedProblem prepare_surface(const MeshProblem& problem, SurfaceModel model,
                                std::shared_ptr<const SizeField> size,
                                const std::function<void(double quads)>& check_count,
                                const Refinement& refinement = {});

/// The same of a mesh that was given, whose nodes on curves stay: patches that end at these and at cuts along
/// sides of elements, and the elements within. `given`: its curves and regions.
PreparedProblem prepare_given_surface(const MeshProblem& problem, GivenSurface surface, const Mesh& given,
                                      std::shared_ptr<const SizeField> size,
                                      const std::function<void(double quads)>& check_count);

}  // namespace delquad
