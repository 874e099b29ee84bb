// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "base/added_parts.h"
#include "delquad/extend.h"

namespace delquad {

/// Return the sizes and the crosses that add_size() and add_cross() added.
AddedParts<std::function<void(const Options&, SizeSpec&)>>& added_sizes();
AddedParts<std::function<void(const Options&, CrossSpec&)>>& added_crosses();

}  // namespace delquad
