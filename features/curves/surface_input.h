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
/// Features of triangles and small parts stay near `kept`. The contents of a CAD file, without compounds, are
/// left in `cad` and not read again. Throws InputError for models that cannot be read, and for options
/// without effect on them. Also throws for compounds of faces that do not exist or are not connected.
SurfaceModel make_surface(const MeshProblem& problem, const std::vector<FeatureBall>& kept,
                          std::shared_ptr<const SurfaceModel>& cad);
SurfaceModel make_surface(const MeshProblem& problem);

/// Returns the length below which parts are left out; 0: none. It is `ignore_below`, or the least length of
/// the criteria, by the least size at these points. Throws InputError if that is not known.
double length_of_small(const MeshProblem& problem, std::span<const Vec3> points);

/// Returns the names of parts that must stay. Throws InputError for a name that no part has.
KeptNames names_that_stay(const MeshProblem& problem, const std::vector<Entity>& curves,
                          const std::vector<Entity>& regions);

/// Returns the model with fewer corners on chains of curves, by SurfaceSpec::simplify, see simplify_curves().
/// If that is absent, short curves are joined to curves that they continue, see merge_short_curves().
/// Otherwise many short edges would end as many rows of quads. Short is a length below a fourth of the size,
/// or below `least` sizes if that is more; variable sizes count where they are least. Curves whose numbers
/// the problem names stay, and short ones with names. All curves stay if sides are periodic or corners of
/// grids are given. Own method.
SurfaceModel join_curves(const MeshProblem& problem, const SizeField& size, SurfaceModel model,
                         double least = 0);

}  // namespace delquad
