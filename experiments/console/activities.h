#pragma once

#include "base/activity.h"

namespace delquad {

/// What this program is at, for its bar, its time limit and signal handlers: the run that main() makes tells
/// it, and those inside of that.
Activities& program_activities();

}  // namespace delquad
