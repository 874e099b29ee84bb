#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace delquad {

/// A size that a file gives at the points of its mesh.
struct SizeFile {
  std::filesystem::path path;
  std::string field;  ///< empty: the only one that it has
};

/// What "FILE" or "FILE:FIELD" means, where FILE ends in .msh or .vtu (and .gz) and counts from `folder`;
/// nothing for other texts.
std::optional<SizeFile> size_file_of(const std::string& text, const std::filesystem::path& folder);

}  // namespace delquad
