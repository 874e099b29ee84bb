#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "delquad/fields.h"

namespace delquad {

/// A size that a file gives at the points of its mesh.
struct SizeFile {
  std::filesystem::path path;
  std::string field;  ///< empty: the only one that it has
};

/// What "FILE" or "FILE:FIELD" means, where FILE ends in .msh or .vtu (and .gz) and counts from `folder`;
/// nothing for other texts.
std::optional<SizeFile> size_file_of(const std::string& text, const std::filesystem::path& folder);

/// Linear between the points of the file's mesh; elsewhere that of the nearest point of it. Throws InputError
/// as read_values() does, and where a value is not positive.
std::unique_ptr<SizeField> make_file_size(const SizeFile& file);

}  // namespace delquad
