// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/parallel.h"

// This header measures time. Stages and the bench use it.

namespace delquad {

/// Seconds since its creation, of this thread and of others that worked for it. The thread that made it reads
/// it.
class Stopwatch {
 public:
  TimeSpent time() const { return time_spent() - spent_; }
  double seconds() const { return time().seconds; }

 private:
  TimeSpent spent_ = time_spent();
};

}  // namespace delquad
