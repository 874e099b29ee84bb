#pragma once

#include <memory>
#include <utility>

#include "fields/fields.h"
#include "geometry/surface/surface_model.h"
#include "mesher/prepare.h"

namespace delquad::testing_support {

/// The problem with this surface, as if it were read, meshed by a size.
inline PreparedProblem prepare_surface(MeshProblem problem, SurfaceModel model,
                                       std::shared_ptr<const SizeField> size) {
  problem.model = ExampleModel{"given"};
  problem.size.field = std::move(size);
  return prepare_problem(problem, {.cad = std::make_shared<SurfaceModel>(std::move(model))});
}

}  // namespace delquad::testing_support
