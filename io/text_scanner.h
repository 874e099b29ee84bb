// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include "base/located.h"
#include "io/mesh_io.h"

// This header cuts text files into tokens. The program, the bench and readers and writers use it.

namespace delquad {

/// Returns the whole file, unpacked when it is compressed by gzip. Throws InputError.
std::string read_whole_file(const std::filesystem::path& path);

/// A file cut into tokens at white space, or into bytes. Every error is an InputError "file:line: message"
/// with the line of the last token. Once bytes were read, it is "file: byte N: message".
class TextScanner {
 public:
  /// Reads the whole file, as read_whole_file(). Without its byte order mark; UTF-16 becomes UTF-8.
  explicit TextScanner(const std::filesystem::path& path);

  /// Returns whether only white space is left.
  bool at_end();
  /// Returns whether only white space is left on the line.
  bool at_end_of_line();
  /// Returns whether the next token begins with c.
  bool next_is(char c) { return !at_end() && text_[at_] == c; }
  /// Goes to what follows lines that begin with '#' or "//".
  void skip_comments();
  /// Lines that end with a backslash go on with the next one from now on.
  void join_continued_lines();
  /// Returns the next token; `what` names it in errors.
  std::string_view token(std::string_view what);
  long long integer(std::string_view what, long long low, long long high);
  /// Returns a number of things that follow, each of a byte at least.
  long long count(std::string_view what);
  /// Returns a finite number.
  double real(std::string_view what, Strays strays = Strays::kRefused);
  /// Returns the same of a number that was read as bytes.
  double finite(double value, Strays strays) const;
  /// Returns a token as it can be shown in a message: short, printable, in quotes.
  static std::string printable(std::string_view token);
  /// Returns the next bytes, as they are; `what` names them in errors.
  std::string_view bytes(size_t count, std::string_view what);
  /// Goes behind the next occurrence of a text; false, and no step, when there is none.
  bool skip_past(std::string_view text);
  /// Returns the rest of the line.
  std::string_view rest_of_line();

  /// Goes to the beginning of the next line; false, and no step, in the last one.
  bool next_line();

  int line() const { return line_; }
  /// Returns the line, or the byte; the other one returns "file:line" or "file: byte N" of it.
  size_t position() const { return in_bytes_ ? at_ : static_cast<size_t>(line_); }
  std::string place(size_t position) const;
  /// Returns the whole file.
  std::string_view text() const { return text_; }
  size_t bytes_left() const { return text_.size() - at_; }
  /// Errors with the place, or the line, and a message that is made as by fmt::format().
  template <class... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> text, Args&&... args) const {
    refuse("{}: {}", place(position()), fmt::format(text, std::forward<Args>(args)...));
  }
  template <class... Args>
  [[noreturn]] void fail_at(int line, fmt::format_string<Args...> text, Args&&... args) const {
    refuse("{}: {}", in_bytes_ ? path_ : place(static_cast<size_t>(line)),
           fmt::format(text, std::forward<Args>(args)...));
  }

 private:
  std::string path_, text_;
  size_t at_ = 0;
  int line_ = 1;
  bool in_bytes_ = false;  ///< lines mean nothing
};

/// Returns the kind of contents that the beginning of a file shows, such as "a STEP file"; empty: unknown.
std::string content_kind(std::string_view text);
inline constexpr const char* kMfemFile = "an MFEM file";

/// Throws InputError when the file shows to be something else than `expected`, which is a name of a format as
/// content_kind() uses it.
void refuse_other_kinds(const TextScanner& in, std::string_view expected);

}  // namespace delquad
