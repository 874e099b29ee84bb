// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <fstream>
#include <system_error>

#include "delquad/error.h"

namespace delquad {

namespace {

/// Shows six digits, or enough for hundredths, which are centimeters in map coordinates.
std::string show_coordinate(double x) {
  constexpr int kLeast = 6, kMost = 15, kHundredths = 3;
  const double size = std::abs(x);
  const int digits = size > 1 && size < 1e15 ? static_cast<int>(std::log10(size)) + kHundredths : kLeast;
  return fmt::format("{:.{}g}", x + 0.0, std::clamp(digits, kLeast, kMost));  // not -0
}

}  // namespace

std::string show_point(Vec2 p) { return fmt::format("({}, {})", show_coordinate(p.x), show_coordinate(p.y)); }

std::string show_point(const Vec3& p) {
  return fmt::format("({}, {}, {})", show_coordinate(p.x), show_coordinate(p.y), show_coordinate(p.z));
}

std::string counted(long long n, std::string_view what) {
  return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
}

std::string first_of(const std::vector<std::string>& texts, std::size_t most, std::string_view between) {
  const auto end = texts.begin() + static_cast<std::ptrdiff_t>(std::min(texts.size(), most));
  return fmt::format("{}{}", fmt::join(texts.begin(), end, between),
                     texts.size() > most ? fmt::format("{}...", between) : "");
}

std::string_view trimmed(std::string_view text) {
  constexpr const char* kBlank = " \t\r\n";
  const auto first = text.find_first_not_of(kBlank);
  return first == std::string_view::npos ? "" : text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::string upper(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c;
  return result;
}

std::optional<double> as_number(std::string_view text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, status] = std::from_chars(text.data(), end, value);
  return status == std::errc{} && stop == end ? std::optional(value) : std::nullopt;
}

std::string cannot_be_read(const std::string& reason) {
  return "cannot be read: " + reason + " [unreadable-file]";
}

std::string file_bytes(const std::filesystem::path& path) {
  const auto refuse = [&](const std::string& reason) {
    throw InputError(path.string() + ": " + cannot_be_read(reason));
  };
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) refuse("it is a folder");
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) refuse(std::generic_category().message(errno));
  std::string bytes;
  constexpr std::size_t kBlock = 1 << 16;
  while (in) {
    const std::size_t before = bytes.size();
    bytes.resize(before + kBlock);
    in.read(bytes.data() + before, kBlock);
    bytes.resize(before + static_cast<std::size_t>(in.gcount()));
  }
  if (in.bad()) refuse(std::generic_category().message(errno));
  return bytes;
}

}  // namespace delquad
