// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

// This header has digests of files. Records of experiments use it.

namespace delquad {

/// Returns the digest of bytes: SHA-1 as a UUID of version 5 [RFC 4122], 36 characters.
std::string digest(std::string_view bytes);
/// Returns the digest of a file's contents; an unchanged file is read once. Throws InputError if it cannot be
/// read.
std::string file_digest(const std::filesystem::path& file);

/// Size and digest of a file, by which changes show.
struct FileMark {
  std::uintmax_t bytes = 0;
  std::string digest;
  bool operator==(const FileMark&) const = default;
};
/// Returns the mark of a file. Throws InputError if it cannot be read.
FileMark mark_of(const std::filesystem::path& file);
/// Returns the marks of the regular files in a folder and in folders inside it, by their paths in it.
std::map<std::string, FileMark> marks_of(const std::filesystem::path& folder);
/// Returns how a file differs from its mark, in words ("holds 12 bytes, expected 300"); empty: it does not.
std::string difference(const std::filesystem::path& file, const FileMark& mark);

/// Returns the text of a JSON object, over several lines, with the further first entry "digest". It shows
/// every later change of the text.
std::string sealed(const std::string& object);
/// Returns whether the text is as sealed() made it.
bool is_sealed(std::string_view text);

}  // namespace delquad
