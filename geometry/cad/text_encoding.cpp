// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/text_encoding.h"

#include <fmt/format.h>

#include <Resource_Unicode.hxx>
#include <TCollection_AsciiString.hxx>
#include <TCollection_ExtendedString.hxx>
#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "base/utf8.h"

namespace delquad::cad {

namespace {

enum class TextEncoding { kUtf8, kGbk, kShiftJis, kLatin1 };

unsigned byte_at(std::string_view text, std::size_t i) { return static_cast<unsigned char>(text[i]); }
bool is_within(unsigned byte, unsigned low, unsigned high) { return low <= byte && byte <= high; }

/// Returns whether all bytes above 0x7F belong to pairs for which `is_pair` holds, none beside a small
/// letter, or satisfy `is_single`.
template <class IsPair, class IsSingle>
bool is_in_pairs(std::string_view text, IsPair is_pair, IsSingle is_single) {
  bool in_word = false;  // behind a small letter
  for (std::size_t i = 0; i < text.size(); ++i) {
    const unsigned byte = byte_at(text, i);
    if (byte < 0x80) {
      in_word = std::islower(static_cast<int>(byte)) != 0;
      continue;
    }
    if (in_word) return false;
    if (is_single(byte)) continue;
    if (i + 1 == text.size() || !is_pair(byte, byte_at(text, i + 1))) return false;
    ++i;
    if (i + 1 < text.size() && std::islower(static_cast<int>(byte_at(text, i + 1))) != 0) return false;
  }
  return true;
}

bool is_valid(const std::string& text, TextEncoding encoding, bool strict) {
  const auto never = [](unsigned) { return false; };
  switch (encoding) {
    case TextEncoding::kUtf8:
      return is_utf8(text);
    case TextEncoding::kGbk:
      return is_in_pairs(
          text,
          [&](unsigned a, unsigned b) {
            return strict ? is_within(a, 0xA1, 0xF7) && is_within(b, 0xA1, 0xFE)
                          : is_within(a, 0x81, 0xFE) && is_within(b, 0x40, 0xFE) && b != 0x7F;
          },
          never);
    case TextEncoding::kShiftJis:
      return is_in_pairs(
          text,
          [](unsigned a, unsigned b) {
            return (is_within(a, 0x81, 0x9F) || is_within(a, 0xE0, 0xEF)) && is_within(b, 0x40, 0xFC) &&
                   b != 0x7F;
          },
          [](unsigned a) { return is_within(a, 0xA1, 0xDF); });
    case TextEncoding::kLatin1:
      break;
  }
  return true;
}

TextEncoding encoding_of(const std::vector<std::string>& texts) {
  struct Try {
    TextEncoding encoding;
    bool strict;
  };
  for (const auto& [encoding, strict] : {Try{TextEncoding::kUtf8, true}, Try{TextEncoding::kGbk, true},
                                         Try{TextEncoding::kShiftJis, true}, Try{TextEncoding::kGbk, false}})
    if (std::ranges::all_of(texts, [&](const std::string& text) { return is_valid(text, encoding, strict); }))
      return encoding;
  return TextEncoding::kLatin1;
}

std::string to_utf8(const std::string& bytes, TextEncoding encoding) {
  if (encoding == TextEncoding::kUtf8 || encoding == TextEncoding::kLatin1) return as_utf8(bytes);
  TCollection_ExtendedString text;
  if (encoding == TextEncoding::kGbk)
    Resource_Unicode::ConvertGBKToUnicode(bytes.c_str(), text);
  else
    Resource_Unicode::ConvertSJISToUnicode(bytes.c_str(), text);
  return as_utf8(TCollection_AsciiString(text).ToCString());
}

/// Returns the bytes of characters below 256; the text itself if there is any other.
std::string bytes_of(const std::string& utf8) {
  std::string bytes;
  for (std::size_t i = 0; i < utf8.size(); ++i) {
    const unsigned first = byte_at(utf8, i);
    if (first > 0xC3) return utf8;
    if (first < 0x80 || i + 1 == utf8.size())
      bytes += utf8[i];
    else
      bytes += static_cast<char>((first & 3) << 6 | (byte_at(utf8, ++i) & 0x3F));
  }
  return bytes;
}

}  // namespace

std::string decode_texts(std::vector<std::string>& texts) {
  const TextEncoding encoding = encoding_of(texts);
  const auto other =
      std::ranges::find_if_not(texts, [](const std::string& text) { return is_utf8(text); }) - texts.begin();
  for (std::string& text : texts) text = to_utf8(text, encoding);
  if (other == std::ssize(texts)) return "";
  constexpr std::array kNames{"UTF-8", "GB 2312 or GBK", "Shift-JIS", "ISO 8859-1"};  // by encoding
  return fmt::format(
      "names are not in UTF-8 and were taken for {}, as '{}': expected UTF-8, or escapes (\\X2\\)",
      kNames[static_cast<std::size_t>(encoding)], texts[static_cast<std::size_t>(other)]);
}

std::string decode_kernel_texts(std::vector<std::string>& texts) {
  std::vector<std::string> bytes;
  for (const std::string& text : texts)
    if (const std::string own = bytes_of(text); own != text) bytes.push_back(own);
  std::string warning = decode_texts(bytes);
  auto next = bytes.begin();
  for (std::string& text : texts)
    if (bytes_of(text) != text) text = *next++;
  return warning;
}

}  // namespace delquad::cad
