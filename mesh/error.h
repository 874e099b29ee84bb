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

/// A face of a surface that cannot be meshed, where others perhaps can.
class FaceError : public InputError {
 public:
  /// `face`: index of the region; the message names it by its tag.
  FaceError(int face, const std::string& message) : InputError(message), face_(face) {}
  int face() const { return face_; }

 private:
  int face_;
};

}  // namespace delquad
