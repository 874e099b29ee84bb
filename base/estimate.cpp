// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/estimate.h"

namespace delquad {

std::function<void(double quads)>& on_estimate() {
  static thread_local std::function<void(double quads)> callback;
  return callback;
}

}  // namespace delquad
