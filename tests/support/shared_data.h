// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdlib>
#include <filesystem>

namespace delquad::testing_support {

/// Where models lie that are no part of the project; tests that need one skip where it is absent.
inline std::filesystem::path shared_data(const std::filesystem::path& file = {}) {
  const char* given = std::getenv("DELQUAD_DATA");
  return std::filesystem::path(given != nullptr ? given : DELQUAD_SHARED_DATA) / file;
}

}  // namespace delquad::testing_support
