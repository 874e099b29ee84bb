// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

// This header checks and makes UTF-8. Readers of files use it.

namespace delquad {

/// Returns whether text is UTF-8, without misplaced bytes, overlong code points, surrogates, and code points
/// above U+10FFFF.
bool is_utf8(std::string_view text);

/// Returns the text if it is UTF-8; otherwise its bytes as ISO 8859-1, so that none is lost.
std::string as_utf8(std::string_view text);

/// Returns UTF-16 text as UTF-8; invalid characters become U+FFFD, and an odd last byte is dropped.
std::string from_utf16(std::string_view bytes, bool is_big_endian);

}  // namespace delquad
