#pragma once

#include "features/layers/layer_columns.h"

namespace delquad {

/// Scales heights down until no quad is inverted, no edge of a front is much shorter than that of the curve
/// below, and fronts keep a distance from each other and from the boundary: at most half their thickness, or
/// an edge. Scales change smoothly along a chain. Throws InputError where nothing helps. `again`: they were
/// fitted before, and some ends are lower now, which may be all right.
void fit_layers(const PatchBoundary& patch, std::span<const LayerSpec> specs, LayerColumns& layers,
                bool again = false);

}  // namespace delquad
