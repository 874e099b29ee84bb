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

// This header composes sizes of their ingredients. The preparation and curves use it.
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
// Lines and meshes that are given have base, names and gradation alone.

namespace delquad {

/// Returns the size without what depends on the model; `own` makes the one that stands in for a base. A
/// function is sampled on `domain`.
std::shared_ptr<const SizeField> base_size(const SizeSpec& spec, const SampleDomain& domain,
                                           std::vector<Warning>& warnings,
                                           const std::function<std::shared_ptr<const SizeField>()>& own);
/// Makes the base size of a planar model of curves, which has no edge lengths of its own.
std::shared_ptr<const SizeField> planar_base_size(const SizeSpec& spec, const PlanarModel& model,
                                                  std::vector<Warning>& warnings);
/// Returns the largest size, in place of a base that was not given. Throws InputError with `why` where there
/// is none.
std::shared_ptr<const SizeField> largest_size(const SizeSpec& size, const std::string& why);

PointSize as_function(std::shared_ptr<const SizeField> size, double scale = 1);

/// Throws InputError for more quads than problem.max_elements. Else calls on_estimate().
void check_count(double quads, const MeshProblem& problem);

/// Returns whether planes of symmetry are given or looked for.
bool is_symmetric(const MeshProblem& problem);

/// Returns a planar model of curves, meshed by its size, which is composed on the way. p.size, p.symmetry and
/// p.plane.background belong to the domain. `spots`: see Refinement.
PlanarDomain mesh_by_size(const MeshProblem& problem, const PlanarModel& model,
                          const std::vector<SizeBall>& spots, const CurveAgreement& agreement,
                          MeshingSetup& p);

/// Returns the size on a surface, of `base` and all ingredients that follow it. `divisions` belong to the
/// model. `cut`: null, or the model is the part.
WantedSize surface_size(const MeshProblem& problem, const SurfaceModel& model,
                        std::shared_ptr<const SizeField> base, const std::vector<CurveDivision>& divisions,
                        const std::vector<SizeBall>& spots, const CutSurface* cut);

/// Returns the integral of dA/delta^2 over the fine triangles, by their centroids; faces that are images have
/// the integral of their masters. `part`: of what, if the triangles are a part of a symmetric model; null:
/// they are all. `unselected`: by region, faces that do not count; empty: none.
double expected_quads(const Mesh& fine, const SurfaceSize& size, const std::vector<FacePair>& images = {},
                      const CutSurface* part = nullptr, const std::vector<char>& unselected = {});

}  // namespace delquad
