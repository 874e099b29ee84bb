#pragma once

#include <memory>
#include <vector>

#include "patches/prepared.h"

namespace delquad {

/// What a problem gets beside what it asks for, because its mesh would not be sound without.
struct Refinement {
  std::vector<SizeSpot> spots = {};
  bool keep_features = false;  ///< of triangulations, in the spots: see TriangulatedOptions::kept_features
  std::shared_ptr<const SurfaceModel> cad = {};  ///< PreparedSurface::cad of before; null: it is read
};

/// Nothing; CAD need not be read again.
Refinement as_read(const PreparedProblem& prepared);

/// Boundary, background mesh and fields of a problem whose files are read. Throws InputError for models and
/// fields that cannot be meshed, and for a size that would need more than problem.max_elements, with the
/// estimate, before that work begins. `refinement`: of surfaces and of planar models of curves.
PreparedProblem prepare_problem(const MeshProblem& problem, const Refinement& refinement = {});

}  // namespace delquad
