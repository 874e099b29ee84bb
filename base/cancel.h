#pragma once

namespace delquad {

/// Throws Cancelled or TimeIsUp, which say at what the run is, when it has been cancelled or its time is up.
/// It takes some nanoseconds: whatever may take longer than about a millisecond calls it on its way. What
/// cannot be interrupted are single calls of other libraries (LEMON's matching, a factorisation, the CAD
/// kernel's projection of a point).
void check_cancelled();
/// The same as an answer, for callbacks of libraries through which nothing may be thrown.
bool is_cancelled() noexcept;

}  // namespace delquad
