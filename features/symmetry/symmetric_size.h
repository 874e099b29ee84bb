#pragma once

#include <memory>

#include "delquad/fields.h"
#include "features/symmetry/symmetry_planes.h"

namespace delquad {

/// At each place the least of the sizes there and at its mirror images. Images whose size is the same to
/// rounding change nothing.
std::shared_ptr<const SizeField> least_of_images(std::shared_ptr<const SizeField> size,
                                                 const SymmetryPlanes& planes);

/// The size on the positive sides, and its mirror image.
std::shared_ptr<const SizeField> folded_size(std::shared_ptr<const SizeField> size,
                                             const SymmetryPlanes& planes);

}  // namespace delquad
