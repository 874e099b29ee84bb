// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

// This header tells estimates of the number of quads. Curves give them, the program prints them.

namespace delquad {

/// Returns the function that this thread calls with each estimate of the number of quads, the first before
/// the work on them begins. Empty: none.
std::function<void(double quads)>& on_estimate();

}  // namespace delquad
