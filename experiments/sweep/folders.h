// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <vector>

// This header writes and removes the folders of cells. Experiments and the program use it.

namespace delquad {

/// Removes the files of an earlier run from a cell's folder, so that they do not pass for files of this run.
/// These are the files that its record lists, and the files that runs without a record leave. Other files
/// stay.
void remove_cell(const std::filesystem::path& folder);

/// Replaces a cell's folder. `write` fills a temporary folder beside it, which then takes its place. So the
/// files appear together or not at all. If the folder holds files of others, they stay, and new files appear
/// one by one. Files of an earlier run are removed in any case. Ctrl-C waits meanwhile. Throws InputError if
/// something cannot be written.
void write_cell(const std::filesystem::path& folder,
                const std::function<void(const std::filesystem::path&)>& write);

/// Makes the folder, or throws InputError when it cannot be made or written to.
void prepare_folder(const std::filesystem::path& folder);

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
