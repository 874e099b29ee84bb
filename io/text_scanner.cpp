// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/text_scanner.h"

#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <climits>
#include <cmath>
#include <limits>
#include <optional>
#include <system_error>

#include "base/text.h"
#include "base/utf8.h"
#include "delquad/error.h"

namespace delquad {
namespace {

bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

std::string_view without_plus(std::string_view token) {
  return token.size() > 1 && token[0] == '+' && token[1] != '-' ? token.substr(1) : token;
}

/// Whether a text is UTF-16 with a byte order mark, and in which order. Each of the first characters must be
/// one of ASCII, so that no bytes of numbers are taken for it.
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

constexpr size_t kBlock = 1 << 16;
constexpr std::string_view kGzip = "\x1f\x8b";

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
  return text;
}

/// Ends the stream whatever happens.
struct Inflation {
  z_stream stream{};
  Inflation() {
    constexpr int kGzipOnly = 16;
    if (inflateInit2(&stream, MAX_WBITS + kGzipOnly) != Z_OK) throw std::bad_alloc();
  }
  Inflation(const Inflation&) = delete;
  Inflation& operator=(const Inflation&) = delete;
  ~Inflation() { inflateEnd(&stream); }
};

/// All members of a gzip file, one after the other.
std::string unpacked(std::string packed, const std::string& name) {
  Inflation inflation;
  z_stream& stream = inflation.stream;
  std::string text;
  size_t fed = 0;
  while (true) {
    if (stream.avail_in == 0 && fed < packed.size()) {
      const size_t n = std::min(packed.size() - fed, size_t{1} << 30);  // zlib counts in 32 bits
      stream.next_in = reinterpret_cast<Bytef*>(packed.data() + fed);
      stream.avail_in = static_cast<uInt>(n);
      fed += n;
    }
    const size_t before = text.size();
    text.resize(before + kBlock);
    stream.next_out = reinterpret_cast<Bytef*>(text.data() + before);
    stream.avail_out = kBlock;
    const int status = inflate(&stream, Z_NO_FLUSH);
    text.resize(before + kBlock - stream.avail_out);
    const bool all_fed = stream.avail_in == 0 && fed == packed.size();
    if (status == Z_STREAM_END) {
      if (all_fed) return text;
      inflateReset(&stream);
    } else if (status == Z_MEM_ERROR) {
      throw std::bad_alloc();
    } else if (status != Z_OK || (all_fed && stream.avail_out > 0)) {
      throw InputError(name + ": is packed by gzip and damaged: expected a whole file");
    }
  }
}

bool begins(std::string_view text, std::string_view with) {
  const size_t first = std::min(text.find_first_not_of(" \t\r\n"), text.size());
  return text.substr(first).starts_with(with);
}

}  // namespace

TextScanner::TextScanner(const std::filesystem::path& path)
    : path_(path.string()), text_(read_whole_file(path)) {
  constexpr size_t kBeginning = 100;  // bytes: numbers have a 0 there
  if (text_.starts_with("\xef\xbb\xbf") && text_.find('\0') >= std::min(kBeginning, text_.size()))
    text_.erase(0, 3);
  else if (const auto is_big = utf16_order(text_))
    text_ = from_utf16(std::string_view(text_).substr(2), *is_big);
}

std::string_view TextScanner::bytes(size_t count, std::string_view what) {
  in_bytes_ = true;
  if (count > bytes_left()) fail("the file ends too early: expected {}", what);
  const std::string_view result = std::string_view(text_).substr(at_, count);
  at_ += count;
  return result;
}

bool TextScanner::skip_past(std::string_view text) {
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
  if (at_end()) fail("the file ends too early: expected {}", what);
  const size_t first = at_;
  while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
  return std::string_view(text_).substr(first, at_ - first);
}

long long TextScanner::integer(std::string_view what, long long low, long long high) {
  const std::string_view text = token(what), digits = without_plus(text);
  long long value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::invalid_argument || end != digits.data() + digits.size()) {
    fail("expected {} (an integer), found {}", what, printable(text));
  }
  if (error != std::errc() || value < low || value > high) {
    fail("expected {} from {} to {}, found {}", what, low, high, printable(text));
  }
  return value;
}

long long TextScanner::count(std::string_view what) {
  const long long n = integer(what, 0, INT_MAX);
  if (n > static_cast<long long>(bytes_left()))
    fail("{} do not fit in the {} bytes that follow: expected {}", n, bytes_left(), what);
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
    fail("expected {} (a finite number), found {}", what, printable(text));
  }
  return finite(value, strays);
}

double TextScanner::finite(double value, Strays strays) const {
  if (std::isfinite(value)) return value;
  if (strays == Strays::kRefused) fail("coordinate {}: expected a finite number", value);
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

std::string read_whole_file(const std::filesystem::path& path) {
  std::string bytes = file_bytes(path);
  return bytes.starts_with(kGzip) ? unpacked(std::move(bytes), path.string()) : bytes;
}

std::string kind_of_file(const std::filesystem::path& path) {
  const std::string kind = lower(path.extension().string());
  return kind == ".gz" ? lower(path.stem().extension().string()) : kind;
}

std::string content_kind(std::string_view text) {
  constexpr size_t kBeginning = 400;  // bytes: a BREP file may have some lines before its title
  const std::string_view beginning = text.substr(0, kBeginning);
  if (begins(text, "ISO-10303-21")) return "a STEP file";
  if (beginning.find("CASCADE Topology V") != std::string_view::npos) return "a BREP file";
  if (begins(text, "$MeshFormat") || begins(text, "$NOD")) return "an MSH file";
  if (begins(text, "MeshVersionFormatted")) return "a Medit file";
  if (begins(text, "MFEM ")) return kMfemFile;
  if (beginning.find("<VTKFile") != std::string_view::npos) return "a VTU file";
  if (begins(text, "# vtk DataFile")) return "a legacy VTK file";
  if (begins(text, "ply\n") || begins(text, "ply\r")) return "a PLY file";
  if (begins(text, "*HEADING") || begins(text, "*Heading") || begins(text, "*NODE") || begins(text, "*Node"))
    return "an INP file";
  for (const char* title : {"OFF", "COFF", "NOFF", "CNOFF", "STOFF"})
    if (begins(text, title)) return "an OFF file";
  if (text.starts_with("PK\x03\x04")) return "a ZIP archive";
  if (text.starts_with("%PDF")) return "a PDF file";
  return "";
}

void refuse_other_kinds(const TextScanner& in, std::string_view expected) {
  const std::string kind = content_kind(in.text());
  if (kind.empty() || kind.find(' ' + std::string(expected) + ' ') != std::string::npos) return;
  in.fail("holds {}: expected {}; files are told apart by the end of their name", kind, expected);
}

}  // namespace delquad
