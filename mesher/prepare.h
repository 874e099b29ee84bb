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

/// Changes to a problem whose mesh was not sound.
struct RetryHints {
  std::vector<SizeBall> spots = {};
  /// Whether sharp edges of triangulations (TriangulatedOptions::kept_features) and small details
  /// (NarrowOptions::kept) stay in the spots.
  bool keep_features = false;
  double ignore_below = 0;   ///< least width of details of surfaces; names stay; 0: as the problem has it
  double size_part = 1;      ///< factor > 0 of all sizes
  double feature_angle = 0;  ///< of triangulations, degrees; 0: as the problem has it
  std::shared_ptr<const SurfaceModel> cad = {};  ///< SurfaceSetup::cad of an earlier setup; null: CAD is read
};

/// Returns hints that change nothing, with the CAD model that was read.
RetryHints no_hints(const MeshingSetup& prepared);

/// Prepares the boundary, background mesh and fields of a problem whose files are read. Throws InputError for
/// models and fields that cannot be meshed. If the size needs more than problem.max_elements, it throws with
/// the estimate before the work begins. `hints` apply to surfaces and planar models of curves.
MeshingSetup prepare_problem(const MeshProblem& problem, const RetryHints& hints = {});

/// Steps from a kind of model to patches. The kinds are planar curves, lines and meshes, surfaces, and given
/// meshes in space.
class ModelSteps {
 public:
  virtual ~ModelSteps() = default;
  /// Reads the model, and the size that it asks for.
  virtual void read(MeshingSetup& p) = 0;
  virtual bool is_surface() const = 0;
  /// Makes the maps of a surface's faces into the plane.
  virtual void flatten(MeshingSetup&) {}
  /// Places nodes on curves, and makes the boundaries of patches.
  virtual void mesh_curves(MeshingSetup& p) = 0;
  /// Makes the patches with their crosses and sizes.
  virtual void make_patches(MeshingSetup& p) = 0;
};

/// Return the steps of a kind of model. The arguments must outlive them.
std::unique_ptr<ModelSteps> planar_steps(const MeshProblem& problem, const RetryHints& hints);
std::unique_ptr<ModelSteps> surface_steps(const MeshProblem& problem, const RetryHints& hints);
std::unique_ptr<ModelSteps> given_surface_steps(const MeshProblem& problem);

/// Returns the cross field of the plane that a problem asks for; null: none. `boundary` has the domain's
/// points.
std::shared_ptr<const CrossField> given_cross(const CrossSpec& spec, const Mesh& boundary, MeshingSetup& p);

/// A problem of a planar model whose outlines are changed before they are meshed.
struct OtherOutlines {
  MeshProblem problem;
  std::vector<Warning> warnings = {};
  bool ignores_small = false;
};
/// Snaps and simplifies outlines, leaves small parts out and adds washers, as the problem asks for or
/// outlines of data need. Returns none if nothing is to be done.
std::optional<OtherOutlines> with_other_outlines(const MeshProblem& problem);

/// Returns the settings by which numbers of edges agree, with fewer steps for a problem that is meshed again.
CurveAgreement agreement_of(const MeshProblem& problem, const RetryHints& hints);

/// Runs all steps in turn, with their times, and returns the prepared problem. Throws as prepare_problem().
MeshingSetup run_model_steps(const MeshProblem& problem, ModelSteps& model);

/// Throws InputError, with problem and place, for a problem that cannot be meshed whatever its files hold.
/// These are unreadable meshes (require_readable()), empty models, numbers out of range and contradictions.
void check_problem(const MeshProblem& problem);

/// Prepares a given mesh, whose nodes on curves stay. Patches end at these curves and at cuts along sides of
/// elements, and contain the elements. `given` has its curves and regions. The number of elements is not
/// limited. Throws InputError if no face can be meshed.
MeshingSetup prepare_given_surface(const MeshProblem& problem, GivenSurface surface, const Mesh& given,
                                   std::shared_ptr<const SizeField> size);

/// Prepares a problem, whose files are read, with its sizes scaled until problem.quads are expected, to 1 %.
/// The problem keeps these sizes. If it has none, the size is uniform. Throws InputError unless problem.quads
/// is from 1 to max_elements.
MeshingSetup prepare_for_quads(MeshProblem& problem);

/// Prepares and meshes a problem, whose files are read.
using Remesh = std::function<std::pair<Prepared, MeshResult>(MeshProblem problem)>;
/// Meshes again with scaled sizes, twice at most, until the number of quads is within 3 % of problem.quads.
/// Both arguments become the nearest mesh, sound ones first, with the time of all; a warning tells a larger
/// difference.
void match_quad_count(const Remesh& remesh, Prepared& prepared, MeshResult& result);

}  // namespace delquad
