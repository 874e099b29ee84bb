// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/utf8.h"

#include <boost/locale/utf.hpp>
#include <iterator>

namespace delquad {

namespace {

using Utf8 = boost::locale::utf::utf_traits<char>;
using Utf16 = boost::locale::utf::utf_traits<char16_t>;

}  // namespace

bool is_utf8(std::string_view text) {
  for (auto at = text.begin(); at != text.end();)
    if (!boost::locale::utf::is_valid_codepoint(Utf8::decode(at, text.end()))) return false;
  return true;
}

std::string as_utf8(std::string_view text) {
  if (is_utf8(text)) return std::string(text);
  std::string latin;
  for (const char c : text) Utf8::encode(static_cast<unsigned char>(c), std::back_inserter(latin));
  return latin;
}

std::string from_utf16(std::string_view bytes, bool is_big_endian) {
  std::u16string units;
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    const auto a = static_cast<unsigned char>(bytes[i]), b = static_cast<unsigned char>(bytes[i + 1]);
    units += static_cast<char16_t>(is_big_endian ? a << 8 | b : b << 8 | a);
  }
  constexpr boost::locale::utf::code_point kUnknown = 0xFFFD;
  std::string text;
  for (auto at = units.cbegin(); at != units.cend();) {
    const auto first = at;
    auto code = Utf16::decode(at, units.cend());
    if (!boost::locale::utf::is_valid_codepoint(code)) {
      code = kUnknown;
      at = std::next(first);
    }
    Utf8::encode(code, std::back_inserter(text));
  }
  return text;
}

}  // namespace delquad
