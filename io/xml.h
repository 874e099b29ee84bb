// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

// This header writes texts and bytes of XML. Formats and reports use it.

namespace delquad {

/// Returns the text with the escapes of XML, also for attributes; control characters become blanks.
inline std::string xml_escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '"')
      result += "&quot;";
    else
      result += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return result;
}

/// Returns the bytes in base64. Boost's iterators take more than twice as long.
inline std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text((bytes.size() + 2) / 3 * 4, '=');
  std::uint32_t held = 0;
  std::size_t n = 0;
  int bits = 0;
  for (const char c : bytes) {
    held = held << 8 | static_cast<unsigned char>(c);
    for (bits += 8; bits >= 6; bits -= 6) text[n++] = kDigits[held >> (bits - 6) & 63];
  }
  if (bits > 0) text[n] = kDigits[held << (6 - bits) & 63];
  return text;
}

}  // namespace delquad
