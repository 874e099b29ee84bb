// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/system.h"

// This header describes the machine. Records and `--version -v` use it.

namespace delquad {

/// The machine that the program runs on.
struct Machine : SystemNames {
  unsigned processors = 0;
};
const Machine& this_machine();

/// Time, and load of the machine then.
struct MachineState {
  std::string time;            ///< UTC, as in ISO 8601: 2026-01-31T23:59:59Z
  std::optional<double> load;  ///< average number of processes that ran or waited to, over the last minute
};
MachineState machine_state();

/// Returns the program's own version ("delquad"), "commit", "build" and "compiler".
std::vector<std::pair<std::string, std::string>> own_versions();
/// Returns these, and the versions of libraries by name. It starts the helper program that reads CAD.
std::vector<std::pair<std::string, std::string>> versions();

}  // namespace delquad
