// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

namespace delquad {

/// Returns the function that this thread calls with each estimate of the number of quads, the first before
/// the work on them begins. Empty: none.
std::function<void(double quads)>& on_estimate();

}  // namespace delquad
