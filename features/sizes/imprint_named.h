#pragma once

#include <memory>
#include <vector>

#include "base/warning.h"
#include "delquad/fields.h"
#include "geometry/surface/surface_model.h"

namespace delquad {

/// Imprints the loose lines and points of a model, and returns the size with what is asked of it by names,
/// theirs among them. Throws InputError as imprint() does, and for a name that nothing has.
std::shared_ptr<const SizeField> imprint_named(const std::vector<NamedSize>& named,
                                               std::shared_ptr<const SizeField> size, SurfaceModel& model,
                                               std::vector<Warning>& warnings);

}  // namespace delquad
