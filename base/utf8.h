#pragma once

#include <string>
#include <string_view>

namespace delquad {

/// Whether text is UTF-8: no byte out of place, no code point that is written too long, a surrogate or beyond
/// U+10FFFF.
bool is_utf8(std::string_view text);

/// Bytes of ISO 8859-1 as UTF-8.
std::string utf8_of_latin1(std::string_view bytes);

/// The text as it is where it is UTF-8, else as if it were ISO 8859-1.
std::string as_utf8(std::string_view text);

}  // namespace delquad
