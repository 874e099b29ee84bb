#pragma once

#include <functional>

#include "base/added_parts.h"
#include "delquad/extend.h"

namespace delquad {

/// What add_size() and add_cross() have added.
AddedParts<std::function<void(const Options&, SizeSpec&)>>& added_sizes();
AddedParts<std::function<void(const Options&, CrossSpec&)>>& added_crosses();

}  // namespace delquad
