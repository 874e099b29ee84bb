#pragma once

#include "mesher/prepare.h"

namespace delquad {

/// Replaces each patch's boundary-aligned field by the size-aware one, on a background mesh made for it: one
/// that follows delta', so that it resolves it. Notes singularities, sum of indices and dislocations.
void make_crosses_size_aware(PreparedProblem& prepared);

}  // namespace delquad
