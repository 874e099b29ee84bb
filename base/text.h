#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "delquad/mesh.h"

/// Texts of messages and files.
namespace delquad {

/// "(x, y)" and "(x, y, z)", six digits each.
std::string show_point(Vec2 p);
std::string show_point(const Vec3& p);
/// "1 triangle", "2 triangles"
std::string counted(long long n, std::string_view what);
/// "a, b, c, ...": the first of some texts.
std::string first_of(const std::vector<std::string>& texts, std::size_t most,
                     std::string_view between = ", ");
/// Without blanks, tabs and line breaks around it.
std::string_view trimmed(std::string_view text);
/// With capitals for a to z.
std::string upper(std::string_view text);
/// The value of a text that is a number and nothing else.
std::optional<double> as_number(std::string_view text);
/// A file's bytes. Throws InputError naming the file, and why it cannot be read.
std::string file_bytes(const std::filesystem::path& path);

}  // namespace delquad
