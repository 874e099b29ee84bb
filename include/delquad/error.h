#pragma once

#include <stdexcept>
#include <string>
#include <utility>

// What functions of this library throw, and what they warn of.

namespace delquad {

/// All that is thrown on purpose, for people to read, but misuse by a program: that is std::logic_error.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Input that cannot be meshed: the message names the file, line or entity and says what was expected.
class InputError : public Error {
 public:
  using Error::Error;
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

/// Work was given up, because it was cancelled. The message says at what it was.
class Cancelled : public Error {
 public:
  using Error::Error;
};

/// The same, because its time was up.
class TimeIsUp : public Cancelled {
 public:
  using Cancelled::Cancelled;
};

/// Something suspicious about a model or a mesh, for people.
struct Warning {
  /// One that stands alone.
  Warning(std::string text_) : text(std::move(text_)) {}
  Warning(const char* text_) : text(text_) {}
  /// One of a kind, named in the plural: "curves shorter than the size". The larger `severity_`, in whatever
  /// unit the kind has, the worse.
  Warning(std::string kind_, double severity_, std::string text_)
      : kind(std::move(kind_)), severity(severity_), text(std::move(text_)) {}

  std::string kind;  ///< empty: it stands alone
  double severity = 0;
  std::string text;

  bool operator==(const Warning&) const = default;
};

}  // namespace delquad
