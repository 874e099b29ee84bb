// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <string>

// This header keeps prepared shapes between runs of the program. Geometry uses it.

namespace delquad::cad {

/// Returns the bytes that answer a question: from `folder` if they are kept there. Else `ask` makes them, and
/// they are kept. Files hold question and answer, so that no other question gets them; damaged ones are made
/// anew. A folder that cannot be written keeps nothing. Above kMostKeptBytes, the files that were used the
/// longest time ago go.
std::string kept_or_asked(const std::filesystem::path& folder, const std::string& question,
                          const std::function<std::string()>& ask);
inline constexpr std::uintmax_t kMostKeptBytes = std::uintmax_t{1} << 30;

}  // namespace delquad::cad
