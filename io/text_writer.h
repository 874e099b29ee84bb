// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <charconv>
#include <concepts>
#include <functional>
#include <ostream>
#include <string>
#include <string_view>
#include <utility>

// This header writes text files. The bench and readers and writers use it.

namespace delquad {

/// Buffered text output; numbers in the shortest form that reads back to the same value.
class TextWriter {
 public:
  explicit TextWriter(std::ostream& out) : out_(out) {}
  TextWriter(const TextWriter&) = delete;
  TextWriter& operator=(const TextWriter&) = delete;
  ~TextWriter() = default;

  TextWriter& operator<<(std::string_view text) {
    buffer_ += text;
    if (buffer_.size() > kBufferSize) flush();
    return *this;
  }
  TextWriter& operator<<(char c) {
    buffer_ += c;
    return *this;
  }
  template <class Number>
  requires(std::integral<Number> || std::floating_point<Number>) &&
      (!std::same_as<Number, char>)TextWriter& operator<<(Number number) {
    char digits[32];
    const char* end = std::to_chars(digits, digits + sizeof digits, number).ptr;
    return *this << std::string_view(digits, static_cast<size_t>(end - digits));
  }
  /// Writes the rest. Call it at the end: the destructor writes nothing, so that no error is lost.
  void flush() {
    out_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
    buffer_.clear();
  }

 private:
  static constexpr size_t kBufferSize = 1 << 16;
  std::ostream& out_;
  std::string buffer_;
};

/// Returns a function that writes a text, for FileToWrite.
inline std::function<void(std::ostream&)> as_text(std::function<void(TextWriter&)> write) {
  return [write = std::move(write)](std::ostream& stream) {
    TextWriter out(stream);
    write(out);
    out.flush();
  };
}

}  // namespace delquad
