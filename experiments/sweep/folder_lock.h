#pragma once

#include <filesystem>
#include <vector>

namespace delquad {

/// The right to write to a folder of results, until it is given up or the process and those it has started
/// are gone.
class FolderLock {
 public:
  /// A whole run, or one of several shards (by index), which may work at the same time. Throws InputError
  /// when another run has the folder.
  FolderLock(const std::filesystem::path& folder, std::size_t shard, std::size_t shards);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  void lock(const std::filesystem::path& file, bool shared);
  std::vector<int> files_;
};

}  // namespace delquad
