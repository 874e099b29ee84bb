#pragma once

#include <filesystem>

namespace delquad {

/// A new folder for temporary files, removed at the end with what it holds.
class ScratchFolder {
 public:
  /// Where the system has its temporary files. Throws InputError when it cannot be made.
  ScratchFolder();
  /// Beside `target`, with a name of its own that begins with a dot.
  explicit ScratchFolder(const std::filesystem::path& target);
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder();
  const std::filesystem::path& path() const { return path_; }

 private:
  explicit ScratchFolder(std::string pattern);
  std::filesystem::path path_;
};

}  // namespace delquad
