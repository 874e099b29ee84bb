// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tests/support/files.h"

namespace delquad::testing_support {

/// An empty folder, in which a shell runs the program with these words.
class Workplace : public TemporaryFolder {
 public:
  ProgramResult run(const std::string& words) const {
    const std::string line = "cd '" + path().string() + "' && exec '" DELQUAD_PROGRAM "' " + words;
    return run_program("/bin/sh", {{"-c", line}, 0, {}});
  }
};

/// A unit square whose sides are called bottom, right, top and left.
inline const std::string kSquare =
    "loop = { rectangle = [[0, 0], [1, 1]], boundary = [\"bottom\", \"right\", \"top\", \"left\"], region = "
    "\"square\" }\n";

}  // namespace delquad::testing_support
