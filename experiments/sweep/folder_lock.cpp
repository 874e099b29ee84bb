#include "experiments/sweep/folder_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "delquad/error.h"

namespace delquad {

FolderLock::FolderLock(const std::filesystem::path& folder, std::size_t shard, std::size_t shards) {
  lock(folder / ".lock", shards > 1);
  if (shards > 1) lock(folder / fmt::format(".lock-{}-of-{}", shard, shards), false);
}

FolderLock::~FolderLock() {
  for (const int file : files_) close(file);
}

void FolderLock::lock(const std::filesystem::path& path, bool shared) {
  constexpr mode_t kMode = 0666;
  const int file = open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, kMode);
  if (file < 0)
    throw InputError(
        fmt::format("{}: cannot be written: {}", path.string(), std::generic_category().message(errno)));
  files_.push_back(file);
  if (flock(file, (shared ? LOCK_SH : LOCK_EX) | LOCK_NB) == 0) return;
  if (errno != EWOULDBLOCK)
    throw InputError(
        fmt::format("{}: cannot be locked: {}", path.string(), std::generic_category().message(errno)));
  throw InputError(path.parent_path().string() +
                   ": another run works on this folder: wait for it, or give another folder");
}

}  // namespace delquad
