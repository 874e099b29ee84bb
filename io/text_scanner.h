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

/// Returns the whole file, unpacked if gzip compressed it. Throws InputError with the path.
std::string read_whole_file(const std::filesystem::path& path);

/// A file as tokens between white space, or as bytes. Every error is an InputError "file:line: message" with
/// the line of the last token; after bytes were read, "file: byte N: message".
class TextScanner {
 public:
  /// Reads the whole file as read_whole_file(), without a byte order mark; UTF-16 becomes UTF-8.
  explicit TextScanner(const std::filesystem::path& path);

  /// Returns whether only white space is left.
  bool at_end();
  /// Returns whether only white space is left on the line.
  bool at_end_of_line();
  /// Returns whether the next token begins with c.
  bool next_is(char c) { return !at_end() && text_[at_] == c; }
  /// Skips lines that begin with '#' or "//".
  void skip_comments();
  /// From now on, lines that end with a backslash continue on the next one.
  void join_continued_lines();
  /// Returns the next token; `what` names it in errors.
  std::string_view token(std::string_view what);
  /// Returns an integer from `low` to `high`.
  long long integer(std::string_view what, long long low, long long high);
  /// Returns a count of following items, each of at least one byte.
  long long count(std::string_view what);
  /// Returns a finite number.
  double real(std::string_view what, Strays strays = Strays::kRefused);
  /// Checks a number that was read as bytes in the same way.
  double finite(double value, Strays strays) const;
  /// Returns a token for messages: short, printable, in quotes.
  static std::string printable(std::string_view token);
  /// Returns the next bytes; `what` names them in errors.
  std::string_view bytes(size_t count, std::string_view what);
  /// Moves behind the next occurrence of a text. Returns false, and does not move, if there is none.
  bool skip_past(std::string_view text);
  /// Returns the rest of the line.
  std::string_view rest_of_line();

  /// Moves to the beginning of the next line. Returns false, and does not move, in the last one.
  bool next_line();

  int line() const { return line_; }
  /// Returns the line, or the byte once bytes were read; place() shows it as "file:line" or "file: byte N".
  size_t position() const { return in_bytes_ ? at_ : static_cast<size_t>(line_); }
  std::string place(size_t position) const;
  /// Returns the whole file.
  std::string_view text() const { return text_; }
  size_t bytes_left() const { return text_.size() - at_; }
  /// Throws InputError with the place, or with this line, and a message formatted by fmt.
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

/// Returns the kind of contents by the beginning of a file, such as "a STEP file"; empty: unknown.
std::string content_kind(std::string_view text);
inline constexpr const char* kMfemFile = "an MFEM file";

/// Throws InputError if content_kind() of the file is known and not `expected`.
void refuse_other_kinds(const TextScanner& in, std::string_view expected);

}  // namespace delquad
