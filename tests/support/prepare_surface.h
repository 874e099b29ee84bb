// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "algorithms/fields/fields.h"
#include "geometry/surface/surface_model.h"
#include "mesher/prepare.h"
#include "mesher/runner.h"

namespace delquad::testing_support {

/// The problem with this surface, as if it were read, meshed by a size.
inline MeshingSetup prepare_surface(MeshProblem problem, SurfaceModel model,
                                    std::shared_ptr<const SizeField> size) {
  if (problem.name.empty()) problem.name = problem.where = "surface";
  problem.model = ExampleModel{"given"};
  problem.size.field = std::move(size);
  return prepare_problem(problem, {.cad = std::make_shared<SurfaceModel>(std::move(model))});
}

inline MeshResult meshed(const MeshingSetup& prepared, const std::string& pipeline) {
  return run_pipeline(prepared, parse_pipeline(pipeline));
}

inline MeshResult meshed(SurfaceModel model, double size, const std::string& pipeline,
                         const MeshProblem& problem = {}) {
  return meshed(prepare_surface(problem, std::move(model), make_constant_size(size)), pipeline);
}

}  // namespace delquad::testing_support
