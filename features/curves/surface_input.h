// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "delquad/mesher.h"
#include "geometry/mesh/entity_names.h"
#include "geometry/surface/triangulated_model.h"

// This header makes surface models of problems. The preparation uses it.

namespace delquad {

/// Returns the surface model of a problem with a TriangleModel, CadModel or ExampleModel, with its compounds.
/// Throws InputError for models that cannot be read, and for options that have no effect on them. So it does
/// for compounds of faces that do not exist or do not hang together. `kept`: where features of triangles
/// stay, and the small parts of any model. `cad`: the contents of a file of CAD, without compounds, are left
/// there, and are not read again.
SurfaceModel make_surface(const MeshProblem& problem, const std::vector<FeatureBall>& kept,
                          std::shared_ptr<const SurfaceModel>& cad);
SurfaceModel make_surface(const MeshProblem& problem);

/// Returns the length below which parts are left out: `ignore_below`, or the criteria's least length, of the
/// least size at these points; 0: none. Throws InputError where that is not known.
double length_of_small(const MeshProblem& problem, std::span<const Vec3> points);

/// Throws InputError for names that are to stay, and that none has.
KeptNames names_that_stay(const MeshProblem& problem, const std::vector<Entity>& curves,
                          const std::vector<Entity>& regions);

/// Joins curves that are shorter than a part of the size (`curves.join_below`, or `least` if that is more)
/// with curves that they continue, see merge_short_curves(). No node is needed where these meet, and so many
/// short edges would make as many rows of quads end. Sizes that vary count where they are least. Curves with
/// names stay, and those that the problem names by their numbers. All stay where sides are periodic or
/// corners of grids are told.
SurfaceModel join_short_curves(const MeshProblem& problem, const SizeField& size, SurfaceModel model,
                               double least = 0);

}  // namespace delquad
