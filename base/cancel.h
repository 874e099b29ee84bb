// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// This header asks whether the run was cancelled. All long loops use it.

namespace delquad {

/// Throws Cancelled or TimeIsUp, with the current step, if the run was cancelled or its time is up. It takes
/// some nanoseconds; work above about a millisecond must call it regularly. Single calls of other libraries
/// cannot be interrupted (LEMON's matching, a factorization, a projection by the CAD kernel).
void check_cancelled();
/// Returns whether check_cancelled() would throw, for callbacks of libraries that pass no exceptions.
bool is_cancelled() noexcept;

}  // namespace delquad
