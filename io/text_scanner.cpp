#include "io/text_scanner.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <system_error>

#include "delquad/error.h"

namespace delquad {

namespace {

bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

std::string_view without_plus(std::string_view token) {
  return token.size() > 1 && token[0] == '+' && token[1] != '-' ? token.substr(1) : token;
}

}  // namespace

TextScanner::TextScanner(const std::filesystem::path& path)
    : path_(path.string()), text_(read_whole_file(path)) {}

std::string_view TextScanner::bytes(size_t count, std::string_view what) {
  in_bytes_ = true;
  if (count > bytes_left()) fail(fmt::format("the file ends where {} was expected", what));
  const std::string_view result = std::string_view(text_).substr(at_, count);
  at_ += count;
  return result;
}

bool TextScanner::skip_behind(std::string_view text) {
  const size_t found = text_.find(text, at_);
  if (found == std::string::npos) return false;
  at_ = found + text.size();
  return true;
}

bool TextScanner::at_end() {
  for (; at_ < text_.size() && is_space(text_[at_]); ++at_) line_ += text_[at_] == '\n';
  return at_ == text_.size();
}

bool TextScanner::at_end_of_line() {
  while (at_ < text_.size() && text_[at_] != '\n' && is_space(text_[at_])) ++at_;
  return at_ == text_.size() || text_[at_] == '\n';
}

std::string_view TextScanner::token(std::string_view what) {
  if (at_end()) fail(fmt::format("the file ends where {} was expected", what));
  const size_t first = at_;
  while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
  return std::string_view(text_).substr(first, at_ - first);
}

long long TextScanner::integer(std::string_view what, long long low, long long high) {
  const std::string_view text = token(what), digits = without_plus(text);
  long long value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::invalid_argument || end != digits.data() + digits.size()) {
    fail(fmt::format("expected {} (an integer), found {}", what, printable(text)));
  }
  if (error != std::errc() || value < low || value > high) {
    fail(fmt::format("expected {} from {} to {}, found {}", what, low, high, printable(text)));
  }
  return value;
}

double TextScanner::real(std::string_view what) {
  const std::string_view text = token(what), digits = without_plus(text);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool is_number = end == digits.data() + digits.size() && error != std::errc::invalid_argument;
  if (!is_number || error != std::errc() || !std::isfinite(value)) {
    fail(fmt::format("expected {} (a finite number), found {}", what, printable(text)));
  }
  return value;
}

std::string_view TextScanner::rest_of_line() {
  const size_t first = at_;
  while (at_ < text_.size() && text_[at_] != '\n') ++at_;
  return std::string_view(text_).substr(first, at_ - first);
}

bool TextScanner::next_line() {
  const size_t end = text_.find('\n', at_);
  if (end == std::string::npos) return false;
  at_ = end + 1;
  ++line_;
  return true;
}

std::string TextScanner::printable(std::string_view token) {
  constexpr size_t kLongest = 40;
  std::string text;
  for (const char c : token.substr(0, kLongest)) text += c >= ' ' && c <= '~' ? c : '?';
  return "'" + text + (token.size() > kLongest ? "...'" : "'");
}

void TextScanner::fail(std::string_view message) const {
  if (in_bytes_) throw InputError(fmt::format("{}: byte {}: {}", path_, at_, message));
  fail(message, line_);
}

void TextScanner::fail(std::string_view message, int line) const {
  if (in_bytes_) throw InputError(fmt::format("{}: {}", path_, message));
  throw InputError(fmt::format("{}:{}: {}", path_, line, message));
}

}  // namespace delquad
