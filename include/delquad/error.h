// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

// This header has the exceptions and warnings of the library. All callers use it.

namespace delquad {

/// Base of all exceptions with messages for people. Misuse by a program is a std::logic_error instead.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The input cannot be meshed. The message names the file, line or entity and the expected input.
class InputError : public Error {
 public:
  using Error::Error;
};

/// A face of a surface cannot be meshed, but other faces perhaps can.
class FaceError : public InputError {
 public:
  /// `face` is the index of the region; the message names it by its tag.
  FaceError(int face, const std::string& message) : InputError(message), face_(face) {}
  int face() const { return face_; }

 private:
  int face_;
};

/// The work was cancelled. The message names the step.
class Cancelled : public Error {
 public:
  using Error::Error;
};

/// The time limit was reached.
class TimeIsUp : public Cancelled {
 public:
  using Cancelled::Cancelled;
};

/// A suspicious property of a model or a mesh, for people.
struct Warning {
  /// A warning that stands alone.
  Warning(std::string text_) : text(std::move(text_)) {}
  Warning(const char* text_) : text(text_) {}
  /// A warning of a kind, named in the plural: "curves shorter than the size". A larger `severity_`, in any
  /// unit of the kind, is worse.
  Warning(std::string kind_, double severity_, std::string text_)
      : kind(std::move(kind_)), severity(severity_), text(std::move(text_)) {}

  std::string kind;  ///< empty: it stands alone
  double severity = 0;
  std::string text;

  bool operator==(const Warning&) const = default;
};

}  // namespace delquad
