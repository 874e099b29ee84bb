// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

// This header finds helper programs of this project. Readers of CAD and figures of experiments use it.

namespace delquad {

/// A program of this project that reads files for the library.
struct HelperProgram {
  std::string name;      ///< "delquad-cad"
  std::string reads;     ///< "CAD files"
  std::string variable;  ///< environment variable that may name one
};

/// Finds the program: named by the variable, or `chosen` by `chooser` unless empty. Otherwise it is beside
/// the running program or this library, or where it was installed. Throws InputError if a named program
/// cannot be run, or no place has it.
std::filesystem::path find_program(const HelperProgram& program, const std::filesystem::path& chosen = {},
                                   const std::string& chooser = {});

}  // namespace delquad
