// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "geometry/surface/surface_model.h"

// This header keeps the projector of a model whose faces were joined. Compounds, washers and imprints use it.

namespace delquad {

/// The former faces (or curves) that each face (or curve) was made of, by index.
using EntityGroups = std::vector<std::vector<int>>;

EntityGroups singleton_groups(std::size_t n);

/// Numbers a model's data of its faces and curves anew, after these were made of former ones. The projector
/// goes to the former face on whose fine triangles the nearest point lies, and to the nearest of the curves.
/// `former`: the triangulation before.
void regroup(SurfaceModel& model, const Mesh& former, const EntityGroups& faces, EntityGroups curves);

/// Returns the same, with more curves, from `first_curve` on: each lies anywhere in its face, `faces`.
std::shared_ptr<const SurfaceProjector> with_curves_on_faces(std::shared_ptr<const SurfaceProjector> base,
                                                             int first_curve, std::vector<int> faces);

/// Takes points out that no triangle and no line has, faces without triangles, curves without lines and
/// corners without curves. Parts the surface where it touches itself at a point without a line. `former`: the
/// triangulation before anything was taken from it.
void tidy_model(SurfaceModel& model, const Mesh& former);

}  // namespace delquad
