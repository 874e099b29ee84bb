#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace delquad {

/// A text file cut into tokens at white space. Every error is an InputError "file:line: message", where the
/// line is that of the last token.
class TextScanner {
 public:
  /// Reads the whole file.
  explicit TextScanner(const std::filesystem::path& path);

  /// Whether only white space is left.
  bool at_end();
  /// Whether only white space is left on the line.
  bool at_end_of_line();
  /// Whether the next token begins with c.
  bool next_is(char c) { return !at_end() && text_[at_] == c; }
  /// The next token; `what` names it in errors.
  std::string_view token(std::string_view what);
  long long integer(std::string_view what, long long low, long long high);
  /// A finite number.
  double real(std::string_view what);
  /// A token as it can be shown in a message: short, printable, in quotes.
  static std::string printable(std::string_view token);
  /// What is left of the line.
  std::string_view rest_of_line();

  int line() const { return line_; }
  /// The whole file.
  std::string_view text() const { return text_; }
  size_t bytes_left() const { return text_.size() - at_; }
  [[noreturn]] void fail(std::string_view message) const { fail(message, line_); }
  [[noreturn]] void fail(std::string_view message, int line) const;

 private:
  std::string path_, text_;
  size_t at_ = 0;
  int line_ = 1;
};

}  // namespace delquad
