#pragma once

#include <vector>

#include "delquad/model.h"

namespace delquad {

/// How far the layers of a column reach from their curve: the first, the second, ..., the whole. Throws
/// InputError for numbers that make no layers.
std::vector<double> layer_heights(const LayerSpec& spec);

}  // namespace delquad
