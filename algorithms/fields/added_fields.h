// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "base/added_parts.h"
#include "delquad/extend.h"

// This header has the sizes and crosses that were registered from outside. Readers of cases use it.

namespace delquad {

/// Return the sizes, or crosses, that add_size() and add_cross() added.
AddedParts<std::function<void(const Options&, SizeSpec&)>>& added_sizes();
AddedParts<std::function<void(const Options&, CrossSpec&)>>& added_crosses();

}  // namespace delquad
