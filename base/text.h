// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "delquad/mesh.h"

// This header formats texts of messages and reads files. All modules use it.
namespace delquad {

/// Returns "(x, y)" or "(x, y, z)" with six digits, or more to show hundredths.
std::string show_point(Vec2 p);
std::string show_point(const Vec3& p);
/// Returns "1 triangle" or "2 triangles".
std::string counted(long long n, std::string_view what);
/// Returns the first texts, at most `most`, joined: "a, b, c, ...".
std::string first_of(const std::vector<std::string>& texts, std::size_t most,
                     std::string_view between = ", ");
/// Returns the text without surrounding blanks, tabs and line breaks.
std::string_view trimmed(std::string_view text);
/// Returns the text with a to z in capitals.
std::string upper(std::string_view text);
/// Returns the decimal number that the whole text is; nothing otherwise.
std::optional<double> as_number(std::string_view text);
/// Returns the message about a file that cannot be read, without its name: "cannot be read: REASON [id]".
std::string cannot_be_read(const std::string& reason);
/// Returns the bytes of a file. Throws InputError with the file and the reason.
std::string file_bytes(const std::filesystem::path& path);

}  // namespace delquad
