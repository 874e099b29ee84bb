#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace delquad {

/// For formats whose library writes files by their name: `write` fills a temporary one, and the file itself
/// is written whole or not at all, see write_file_atomically().
void write_by_library(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

/// Throws InputError that names the file, the library and what it could not do, where `done` is false.
void require_written(bool done, const std::filesystem::path& path, const std::string& library,
                     const char* what);

/// Throws InputError that names the Debian package without which this program was built.
[[noreturn]] void refuse_without_library(const std::filesystem::path& path, const std::string& package);

}  // namespace delquad
