#pragma once

#include "delquad/fields.h"
#include "patches/prepared.h"

namespace delquad {

/// Replaces each patch's field by that of the spec's maker. What was known of singularities goes.
void use_made_crosses(const CrossSpec& spec, PreparedProblem& prepared);

}  // namespace delquad
