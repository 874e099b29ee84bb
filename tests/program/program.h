#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/run_program.h"

namespace delquad::testing_support {

inline ProgramResult delquad(std::vector<std::string> arguments) {
  return run_program(DELQUAD_PROGRAM, {std::move(arguments), 0, {}});
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

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
