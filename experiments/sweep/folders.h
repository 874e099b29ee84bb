// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <vector>

// This header writes and removes the folders of cells. Experiments and the program use it.

namespace delquad {

/// Removes files of an earlier run from a cell's folder: the files that its record lists, and files that runs
/// without a record leave. Other files stay.
void remove_cell(const std::filesystem::path& folder);

/// Replaces a cell's folder. `write` fills a temporary folder beside it, which then takes its place, so files
/// appear together or not at all. Foreign files stay, and new files then appear one by one. Files of an
/// earlier run are always removed. Ctrl-C waits meanwhile. Throws InputError if something cannot be written.
void write_cell(const std::filesystem::path& folder,
                const std::function<void(const std::filesystem::path&)>& write);

/// Makes the folder if necessary. Throws InputError if it cannot be made or written to.
void prepare_folder(const std::filesystem::path& folder);

/// A lock on a folder of results, until it is destroyed or this process and its children have ended.
class FolderLock {
 public:
  /// Locks for a whole run, or for one of several shards (by index), which may run at the same time. Throws
  /// InputError if another run has the folder.
  FolderLock(const std::filesystem::path& folder, std::size_t shard, std::size_t shards);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  void lock(const std::filesystem::path& file, bool shared);
  std::vector<int> files_;
};

}  // namespace delquad
