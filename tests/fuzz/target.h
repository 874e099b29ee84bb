// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "delquad/error.h"

// This header describes a fuzz target. A target takes any bytes. It must end with a result that holds, or
// with an InputError that says what is wrong. Anything else (a crash, another exception, a wrong result) is a
// finding.

namespace delquad::fuzz {

struct Target {
  std::string name;  ///< of its folder in corpus/ and its file in dictionaries/, too
  /// Whether it came to a result; else to an InputError. Throws what is a finding.
  bool (*try_input)(std::string_view bytes);
  std::vector<std::string> (*seeds)();  ///< small inputs that come to a result, from which fuzzing starts
  int longest = 4096;                   ///< bytes of an input
};

// One list for each program: what it links is what it counts the coverage of.
std::vector<Target> reader_targets();  ///< of io/: files of meshes
std::vector<Target> case_targets();    ///< of cases/: model files, formulas
std::vector<Target> result_targets();  ///< of experiments/sweep/: experiments, records, studies
std::vector<Target> cad_targets();     ///< of geometry/cad/: CAD files, through the process that reads them
std::vector<Target> mesher_targets();  ///< public API: domains and triangulations that the bytes draw
/// Throws std::logic_error, which is a finding, unless it is true.
void require(bool is_true, std::string_view what);

/// Requires that the message of an InputError is one line that can be printed and begins with `where`. Throws
/// as require().
void check_message(const std::string& message, const std::string& where);

/// The last one that was checked: why an input was refused.
const std::string& last_message();

/// Calls `use`, which may throw an InputError with such a message; false: it did.
template <class Use>
bool result_or_input_error(const std::string& where, Use use) {
  try {
    use();
    return true;
  } catch (const InputError& error) {
    check_message(error.what(), where);
    return false;
  }
}

}  // namespace delquad::fuzz
