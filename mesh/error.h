#pragma once

#include <stdexcept>
#include <string>

namespace delquad {

/// Input that cannot be meshed: the message names the file, line or entity and says what was expected.
/// The program prints it and exits with code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace delquad
