#pragma once

#include "delquad/mesher.h"
#include "geometry/surface/surface_model.h"

namespace delquad {

/// The model with curves shorter than a part of the size (`curves.join_below`) made one with those that they
/// continue, see merge_short_curves(): no node is needed where these meet, and so many short edges would make
/// as many rows of quads end. Sizes that vary count where they are least. Curves with names stay, and those
/// that the problem names by their numbers; all stay where sides are periodic or corners of grids are told.
SurfaceModel join_short_curves(const MeshProblem& problem, const SizeField& size, SurfaceModel model);

}  // namespace delquad
