// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tests/support/files.h"

namespace delquad::testing_support {

/// Two sizes of a square, one of them meshed, triangles and quads, with smoothing; and a case that fails.
inline const std::string kSquareExperiment = R"(
title = "A square </script> & <b>more</b>"
pipelines = ["D", "DB", "DLB"]
[matrix]
seed = [1, 2]
[[case]]
name = "square"
size = 0.1
loop = { rectangle = [[0, 0], [1, 1]] }
[[case]]
name = "broken"
size = 0.1
loop = [{ rectangle = [[0, 0], [1, 1]] }, { rectangle = [[0.5, 0.5], [2, 2]] }]
)";

/// Runs an experiment into folder/name.
inline ProgramResult run_into(const TemporaryFolder& folder, const std::string& name,
                              const std::string& experiment) {
  const auto file = write_text(folder / (name + ".toml"), experiment);
  return delquad({"run", file, "-o", folder.path() / "results" / name, "--threads", "1"});
}

}  // namespace delquad::testing_support
