// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "algorithms/insertion/frontal_mesher.h"
#include "algorithms/recombination/recombine.h"
#include "algorithms/treatment/treatment.h"
#include "delquad/extend.h"
#include "features/curves/mesh_surface_curves.h"
#include "geometry/surface/improve_triangulation.h"
#include "smoothing/surface/surface_tracks.h"
#include "tests/support/meshing.h"

namespace delquad::testing_support {

/// The patches of a model, meshed by D and matched.
struct MeshedSurface {
  MeshedSurface(SurfaceModel given, double h, bool treated)
      : model(std::move(given)), size(make_constant_size(h)) {
    improve_triangulation(model);
    domain = make_surface_domain(model, flatten(model), size, *make_primal_dual_solver());
    nodes = domain.nodes;
    quads.resize(domain.patches.size()), inside.resize(domain.patches.size());
    for (std::size_t p = 0; p < domain.patches.size(); ++p) {
      const SurfacePatch& patch = domain.patches[p];
      crosses.push_back(std::make_unique<HarmonicCrossField>(patch.background));
      const SurfacePatchSize delta(patch, model.fine, size);
      quads[p] = recombine(mesh_frontal(patch.boundary, *make_linf_delquad(), *crosses[p], delta),
                           *make_primal_dual_solver());
      if (treated) quads[p] = treat_paper(quads[p], delta);
    }
  }
  MeshedSurface(const MeshedSurface&) = delete;

  SurfaceModel model;
  SurfaceSize size;
  SurfaceDomain domain;
  SurfaceNodes nodes;
  std::vector<std::unique_ptr<HarmonicCrossField>> crosses;
  std::vector<QuadPatch> quads;
  std::vector<std::vector<Vec3>> inside;  ///< places of the patches' inner points, for a test to fill
};

}  // namespace delquad::testing_support
