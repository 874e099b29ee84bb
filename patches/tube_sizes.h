#pragma once

#include <vector>

#include "fields/fields.h"
#include "patches/patch_outline.h"

namespace delquad {

/// The largest size at each vertex of each map for which quads do not meet themselves around a tube: a fourth
/// of the way from one side of a cut to the other. Empty for patches that bound no curve from both sides, or
/// where this asks for nothing. Towards the tip of a cone the way shrinks to nothing, which the size does not
/// follow below a part of `size`: see cap_tips().
std::vector<std::vector<double>> tube_sizes(const Mesh& fine, const std::vector<CurveChain>& chains,
                                            const std::vector<FlatPatch>& maps,
                                            const std::vector<PatchOutline>& outlines, const SizeField& size);

}  // namespace delquad
