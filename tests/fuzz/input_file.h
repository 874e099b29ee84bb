// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "tests/support/temporary_folder.h"

namespace delquad::fuzz {

/// The one file of a target that reads files, written anew for each input.
class InputFile {
 public:
  /// `name`: with the extension, and perhaps folders before.
  explicit InputFile(const std::string& name) : path_(folder_ / name) {
    std::filesystem::create_directories(path_.parent_path());
  }

  const std::filesystem::path& hold(std::string_view bytes) {
    std::ofstream out(path_, std::ios::binary | std::ios::trunc);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out) throw std::runtime_error(path_.string() + ": cannot be written");
    return path_;
  }
  const std::filesystem::path& folder() const { return folder_.path(); }

 private:
  testing_support::TemporaryFolder folder_;
  std::filesystem::path path_;
};

}  // namespace delquad::fuzz
