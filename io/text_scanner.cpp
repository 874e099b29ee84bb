#include "io/text_scanner.h"

#include <fmt/format.h>

#include <charconv>
#include <climits>
#include <cmath>
#include <limits>
#include <optional>
#include <system_error>

#include "base/utf8.h"
#include "delquad/error.h"

namespace delquad {

namespace {

bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

std::string_view without_plus(std::string_view token) {
  return token.size() > 1 && token[0] == '+' && token[1] != '-' ? token.substr(1) : token;
}

/// Of UTF-16 with a byte order mark, where each of the first characters is one of ASCII: no bytes of numbers
/// are taken for it. Returns whether it is, and of which order.
std::optional<bool> utf16_order(std::string_view text) {
  const bool is_big = text.starts_with("\xfe\xff");
  if (!is_big && !text.starts_with("\xff\xfe")) return std::nullopt;
  constexpr size_t kBytes = 18;
  for (size_t i = 2; i < std::min(kBytes, text.size()); ++i)
    if ((text[i] == '\0') != ((i % 2 == 0) == is_big)) return std::nullopt;
  return is_big;
}

/// How a line ends that goes on with the next one, once they are joined: white space that counts as a line.
constexpr char kJoint = '\v';

}  // namespace

TextScanner::TextScanner(const std::filesystem::path& path)
    : path_(path.string()), text_(read_whole_file(path)) {
  constexpr size_t kBeginning = 100;  // bytes: those of numbers have a 0 there
  if (text_.starts_with("\xef\xbb\xbf") && text_.find('\0') >= std::min(kBeginning, text_.size()))
    text_.erase(0, 3);
  else if (const auto is_big = utf16_order(text_))
    text_ = from_utf16(std::string_view(text_).substr(2), *is_big);
}

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
  for (; at_ < text_.size() && is_space(text_[at_]); ++at_)
    line_ += text_[at_] == '\n' || text_[at_] == kJoint;
  return at_ == text_.size();
}

void TextScanner::skip_comments() {
  while (next_is('#') || std::string_view(text_).substr(at_).starts_with("//")) rest_of_line();
}

void TextScanner::join_continued_lines() {
  for (size_t at = text_.find('\\', at_); at != std::string::npos; at = text_.find('\\', at + 1)) {
    const size_t end = text_.find_first_not_of(" \t\r", at + 1);
    if (end == std::string::npos || text_[end] != '\n') continue;
    const size_t begin = text_.find_first_not_of(" \t", text_.rfind('\n', at) + 1);
    if (text_[begin] == '#') continue;  // a comment ends with its line
    text_[at] = ' ';
    text_[end] = kJoint;
  }
}

bool TextScanner::at_end_of_line() {
  for (; at_ < text_.size() && text_[at_] != '\n' && is_space(text_[at_]); ++at_)
    line_ += text_[at_] == kJoint;
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

long long TextScanner::count(std::string_view what) {
  const long long n = integer(what, 0, INT_MAX);
  if (n > static_cast<long long>(bytes_left()))
    fail(fmt::format("{} do not fit in the {} bytes that follow: expected {}", n, bytes_left(), what));
  return n;
}

double TextScanner::real(std::string_view what, Strays strays) {
  const std::string_view text = token(what), digits = without_plus(text);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool is_number = end == digits.data() + digits.size() && error != std::errc::invalid_argument;
  if (is_number && error == std::errc::result_out_of_range)
    value = digits.find_first_of("eE") < digits.rfind('-') && digits.rfind('-') != std::string_view::npos
                ? 0.0
                : std::numeric_limits<double>::infinity();
  if (!is_number || (strays == Strays::kRefused && !std::isfinite(value))) {
    fail(fmt::format("expected {} (a finite number), found {}", what, printable(text)));
  }
  return finite(value, strays);
}

double TextScanner::finite(double value, Strays strays) const {
  if (std::isfinite(value)) return value;
  if (strays == Strays::kRefused) fail(fmt::format("coordinate {}: expected a finite number", value));
  return std::numeric_limits<double>::max();
}

std::string_view TextScanner::rest_of_line() {
  const size_t first = at_;
  for (; at_ < text_.size() && text_[at_] != '\n'; ++at_) line_ += text_[at_] == kJoint;
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

std::string TextScanner::place(size_t position) const {
  return in_bytes_ ? fmt::format("{}: byte {}", path_, position) : fmt::format("{}:{}", path_, position);
}

void TextScanner::fail(std::string_view message) const {
  throw InputError(fmt::format("{}: {}", place(position()), message));
}

void TextScanner::fail(std::string_view message, int line) const {
  if (in_bytes_) throw InputError(fmt::format("{}: {}", path_, message));
  throw InputError(fmt::format("{}:{}: {}", path_, line, message));
}

}  // namespace delquad
