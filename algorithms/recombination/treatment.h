#pragma once

#include "fields/size_field.h"
#include "mesh/patch.h"

namespace delquad {

struct TreatmentOptions {
  int max_rounds = 20;  ///< rounds of topology and relocation; stops earlier when a round changes no topology
};

struct TreatmentSummary {
  int rounds = 0, doublets = 0, diamonds = 0, swaps = 0, boundary_repairs = 0, relocated = 0;
  double seconds = 0;
};

/// The clean-up that the paper's tables include: doublets, diamonds, swaps of poor pairs, vertex relocation.
/// Boundary points stay where they are, in their order; the mesh stays conforming, oriented and of the same
/// topology type; quads stay quads.
QuadPatch treat_paper(QuadPatch mesh, const ParametricSize& size, const TreatmentOptions& options = {},
                      TreatmentSummary* summary = nullptr);

}  // namespace delquad
