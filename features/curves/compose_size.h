// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "algorithms/fields/sampled_fields.h"
#include "algorithms/fields/surface/surface_size.h"
#include "delquad/mesher.h"
#include "features/curves/agreement.h"
#include "features/periodic/periodic.h"
#include "features/symmetry/mirrored_surface.h"
#include "geometry/patches/meshing_setup.h"
#include "geometry/planar/planar_model.h"

// This header composes sizes from their ingredients. The preparation and curves use it.
//
// | ingredient                        | planar models of curves        | surfaces                       |
// |-----------------------------------|--------------------------------|--------------------------------|
// | base, sources, the largest size   | base_size()                    | base_size()                    |
// | sizes by name                     | in turn with the curves, twice | imprint_named()                |
// | the least of mirror images        | least_of_images()              | cut_at_planes()                |
// | gradation                         | along the background mesh      | last, along the surface        |
// | curvature                         | none                           | surface_size()                 |
// | given edges, short curves, spots  | last                           | surface_size()                 |
//
// Given lines and meshes have only base, names and gradation.

namespace delquad {

/// The growth of sizes away from curves that are shorter than the size, and from spots.
inline constexpr double kShortCurveGradation = 0.7;

/// Returns the part of the size that does not depend on the model. `own` makes the size that replaces a
/// missing base. A function is sampled on `domain`. Throws InputError for sizes that are not finite and
/// positive.
std::shared_ptr<const SizeField> base_size(const SizeSpec& spec, const SampleDomain& domain,
                                           std::vector<Warning>& warnings,
                                           const std::function<std::shared_ptr<const SizeField>()>& own);
/// Returns the base size of a planar model of curves, which has no edge lengths of its own. Throws InputError
/// as largest_size().
std::shared_ptr<const SizeField> planar_base_size(const SizeSpec& spec, const PlanarModel& model,
                                                  std::vector<Warning>& warnings);
/// Returns the constant `size.max`, in place of a missing base. Throws InputError with `why` if it is 0.
std::shared_ptr<const SizeField> largest_size(const SizeSpec& size, const std::string& why);

/// Throws InputError for more quads than problem.max_elements. Else calls on_estimate().
void check_count(double quads, const MeshProblem& problem);

/// Returns whether planes of symmetry are given or sought.
bool is_symmetric(const MeshProblem& problem);

/// Returns the domain of a planar model of curves, meshed by its size, which is composed meanwhile. p.size
/// and p.plane.background belong to the domain. Sizes are smaller at `spots`, see RetryHints. Throws
/// InputError as make_domain().
PlanarDomain mesh_by_size(const MeshProblem& problem, const PlanarModel& model,
                          const std::vector<SizeBall>& spots, const CurveAgreement& agreement,
                          MeshingSetup& p);

/// Returns the size on a surface: `base` and all ingredients that follow it. `divisions` belong to the model.
/// If `cut` is not null, the model is its part.
WantedSize surface_size(const MeshProblem& problem, const SurfaceModel& model,
                        std::shared_ptr<const SizeField> base, const std::vector<CurveDivision>& divisions,
                        const std::vector<SizeBall>& spots, const CutSurface* cut);

/// Returns the integral of dA/delta^2 over the fine triangles, by their centroids. Faces that are images have
/// the integral of their masters. `part` is the symmetric model whose part the triangles are; null: they are
/// all.
double expected_quads(const Mesh& fine, const SurfaceSize& size, const std::vector<FacePair>& images = {},
                      const CutSurface* part = nullptr, const std::vector<char>& unselected = {});

}  // namespace delquad
