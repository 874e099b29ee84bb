#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace delquad {

/// Tells contents apart: SHA-1 as a UUID of version 5 (36 characters).
std::string digest(std::string_view bytes);
/// Of a file's contents; each file is read once while it stays as it is. Throws InputError when it cannot be
/// read.
std::string file_digest(const std::filesystem::path& file);

}  // namespace delquad
