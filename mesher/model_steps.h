#pragma once

#include <functional>
#include <memory>

#include "features/given/given_surface.h"
#include "geometry/surface/surface_model.h"
#include "mesher/prepare.h"

namespace delquad {

/// A model on its way to patches: planar curves, lines and meshes; surfaces; meshes in space that were given.
class ModelSteps {
 public:
  virtual ~ModelSteps() = default;
  /// The model, and the size that it asks for.
  virtual void read(PreparedProblem& p) = 0;
  virtual bool is_surface() const = 0;
  /// The maps of a surface's faces into the plane.
  virtual void flatten(PreparedProblem&) {}
  /// Curves, and the patches' boundaries.
  virtual void mesh_curves(PreparedProblem& p) = 0;
  /// Patches, with their crosses and sizes.
  virtual void make_patches(PreparedProblem& p) = 0;
};

std::unique_ptr<ModelSteps> planar_steps(const MeshProblem& problem, const Refinement& refinement);
std::unique_ptr<ModelSteps> surface_steps(const MeshProblem& problem, const Refinement& refinement);
std::unique_ptr<ModelSteps> given_surface_steps(const MeshProblem& problem, const GivenMesh& given);

/// All of them in turn.
PreparedProblem prepare_by(const MeshProblem& problem, ModelSteps& model);

}  // namespace delquad
