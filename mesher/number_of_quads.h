#pragma once

#include <functional>
#include <utility>

#include "base/counters.h"
#include "delquad/mesher.h"
#include "patches/prepared.h"

// Meshes of about as many quads as are asked for (MeshProblem::quads), by other sizes.

namespace delquad {

/// What meet_quads() did.
struct NumberSummary {
  int asked = 0;
  int meshes = 0;  ///< that were made, the first and the last included
};

template <>
struct Counters<NumberSummary> {
  using S = NumberSummary;
  static constexpr const char* step = "number_of_quads";
  static constexpr auto all = std::tuple{counter("asked", &S::asked), counter("meshes", &S::meshes)};
};

/// The problem, whose files are read, by sizes at which as many quads are expected; these are its own then.
/// Where it has none, the size is the same everywhere. Throws InputError for numbers that cannot be.
PreparedProblem prepare_for_quads(MeshProblem& problem);

/// Meshes a problem, whose files are read.
using MeshAnew = std::function<std::pair<Prepared, MeshResult>(MeshProblem problem)>;
/// Meshes anew by other sizes, twice at most, until there are as many quads as are asked for to 3 %. Both
/// become those of the nearest mesh, sound ones first, with the time of all; a warning tells where that is
/// not near enough.
void meet_quads(const MeshAnew& mesh_anew, Prepared& prepared, MeshResult& result);

}  // namespace delquad
