// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "delquad/error.h"

// This header sums up warnings. The program and the bench use it.

namespace delquad {

/// Returns a line for each kind, in the order of first warnings. It has the only text, or the number of
/// warnings and the text of highest severity.
std::vector<std::string> summaries(const std::vector<Warning>& warnings);

/// Returns the text of each warning.
std::vector<std::string> texts(const std::vector<Warning>& warnings);

}  // namespace delquad
