#pragma once

#include <string>
#include <string_view>

namespace delquad {

/// Whether text is UTF-8: no byte out of place, no code point that is written too long, a surrogate or beyond
/// U+10FFFF.
bool is_utf8(std::string_view text);

/// The text where it is UTF-8; else its bytes are taken for ISO 8859-1, so that nothing of them is lost.
std::string as_utf8(std::string_view text);

/// Text of units of two bytes as UTF-8; U+FFFD for what is no character.
std::string from_utf16(std::string_view bytes, bool is_big_endian);

}  // namespace delquad
