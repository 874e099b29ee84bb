// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "geometry/surface/surface_model.h"

// This header keeps the projector of a model whose faces were joined. Compounds, washers and imprints use it.

namespace delquad {

/// The former faces (or curves) of each face (or curve), by index.
using EntityGroups = std::vector<std::vector<int>>;

/// Returns n groups, each of its own index.
EntityGroups singleton_groups(std::size_t n);

/// Renumbers the data of a model by face and curve after these replaced former ones. The projector goes to
/// the former face whose fine triangles have the nearest point, and to the nearest of the former curves.
/// `former` is the triangulation before.
void regroup(SurfaceModel& model, const Mesh& former, const EntityGroups& faces, EntityGroups curves);

/// Returns a projector with more curves, from `first_curve` on: points on them are projected to their faces,
/// `faces`.
std::shared_ptr<const SurfaceProjector> with_curves_on_faces(std::shared_ptr<const SurfaceProjector> base,
                                                             int first_curve, std::vector<int> faces);

/// Removes unused points, faces without triangles, curves without lines and corners without curves. Separates
/// the surface where it touches itself at a point without a line. `former` is the triangulation before any
/// removal.
void tidy_model(SurfaceModel& model, const Mesh& former);

}  // namespace delquad
