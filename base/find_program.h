#pragma once

#include <filesystem>
#include <string>

namespace delquad {

/// A program of ours that reads files for us.
struct HelperProgram {
  std::string name;      ///< "delquad-cad"
  std::string reads;     ///< "CAD files"
  std::string variable;  ///< of the environment, which may name one
};

/// Where it is: what the variable names, else `chosen`, unless that is empty, by `chooser`; else beside the
/// running program or the library that this code is in, or where it was installed. Throws InputError, naming
/// the places, when it is not there.
std::filesystem::path find_program(const HelperProgram& program, const std::filesystem::path& chosen = {},
                                   const std::string& chooser = {});

}  // namespace delquad
