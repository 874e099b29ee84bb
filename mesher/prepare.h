// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "delquad/mesher.h"
#include "features/curves/agreement.h"
#include "features/given/given_surface.h"
#include "geometry/patches/meshing_setup.h"
#include "geometry/surface/surface_model.h"

// This header makes patches, sizes and fields from a problem. The pipeline uses it.

namespace delquad {

/// Changes to a problem without which its mesh would not be sound.
struct RetryHints {
  std::vector<SizeBall> spots = {};
  /// In the spots: of triangulations, see TriangulatedOptions::kept_features, and what is small, see
  /// NarrowOptions::kept.
  bool keep_features = false;
  double ignore_below = 0;                       ///< of surfaces, names stay; 0: as the problem has it
  double size_part = 1;                          ///< all sizes become this part of what they are
  double feature_angle = 0;                      ///< of triangulations, degrees; 0: as the problem has it
  std::shared_ptr<const SurfaceModel> cad = {};  ///< SurfaceSetup::cad of before; null: it is read
};

/// Returns no hints; CAD need not be read again.
RetryHints no_hints(const MeshingSetup& prepared);

/// Prepares the boundary, background mesh and fields of a problem whose files are read. Throws InputError for
/// models and fields that cannot be meshed. If the size needs more than problem.max_elements, it throws with
/// the estimate before the work begins. `hints`: of surfaces and of planar models of curves.
MeshingSetup prepare_problem(const MeshProblem& problem, const RetryHints& hints = {});

/// A model on its way to patches: planar curves, lines and meshes; surfaces; meshes in space that were given.
class ModelSteps {
 public:
  virtual ~ModelSteps() = default;
  /// Reads the model, and the size that it asks for.
  virtual void read(MeshingSetup& p) = 0;
  virtual bool is_surface() const = 0;
  /// Makes the maps of a surface's faces into the plane.
  virtual void flatten(MeshingSetup&) {}
  /// Curves, and the patches' boundaries.
  virtual void mesh_curves(MeshingSetup& p) = 0;
  /// Patches, with their crosses and sizes.
  virtual void make_patches(MeshingSetup& p) = 0;
};

std::unique_ptr<ModelSteps> planar_steps(const MeshProblem& problem, const RetryHints& hints);
std::unique_ptr<ModelSteps> surface_steps(const MeshProblem& problem, const RetryHints& hints);
std::unique_ptr<ModelSteps> given_surface_steps(const MeshProblem& problem);

/// A problem of a planar model whose outlines are changed before they are meshed.
struct OtherOutlines {
  MeshProblem problem;
  std::vector<Warning> warnings = {};
  bool ignores_small = false;
};
/// Snaps and simplifies outlines, leaves small parts out and adds washers, as the problem asks for or
/// outlines of data need. Returns none if nothing is to be done.
std::optional<OtherOutlines> with_other_outlines(const MeshProblem& problem);

/// Returns how far numbers of edges agree; with few steps for a problem that is meshed anew.
CurveAgreement agreement_of(const MeshProblem& problem, const RetryHints& hints);

/// Runs all steps in turn.
MeshingSetup run_model_steps(const MeshProblem& problem, ModelSteps& model);

/// Throws InputError, saying what is wrong and where, for a problem that makes no sense, whatever its model
/// holds. Such problems have meshes that cannot be read (see require_readable()), models with nothing in
/// them, numbers out of range, or contradictions.
void check_problem(const MeshProblem& problem);

/// Prepares a given mesh, whose nodes on curves stay. Patches end at these curves and at cuts along sides of
/// elements, and contain the elements. `given`: its curves and regions. The number of elements is not
/// limited.
MeshingSetup prepare_given_surface(const MeshProblem& problem, GivenSurface surface, const Mesh& given,
                                   std::shared_ptr<const SizeField> size);

/// Returns the problem, whose files are read, by sizes at which as many quads are expected; these are its own
/// then. Where it has none, the size is the same everywhere. Throws InputError for numbers that cannot be.
MeshingSetup prepare_for_quads(MeshProblem& problem);

/// Meshes a problem, whose files are read.
using Remesh = std::function<std::pair<Prepared, MeshResult>(MeshProblem problem)>;
/// Meshes anew by other sizes, twice at most, until there are as many quads as are asked for to 3 %. Both
/// become the result of the nearest mesh, sound ones first, with the time of all; a warning tells where that
/// is not near enough.
void match_quad_count(const Remesh& remesh, Prepared& prepared, MeshResult& result);

}  // namespace delquad
