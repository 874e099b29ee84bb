// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/folders.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "base/located.h"
#include "base/process.h"
#include "base/system.h"
#include "delquad/error.h"
#include "experiments/console/interrupt.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;

constexpr const char *kRecord = "record.json", *kTemporary = ".tmp";

/// Removed at the end unless it has been moved away.
struct UnfinishedFolder {
  fs::path path;
  ~UnfinishedFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

/// The files of a cell: what all cells have, and what its record says.
std::vector<fs::path> files_of_cell(const fs::path& folder) {
  std::vector<fs::path> files = {"mesh.msh", "mesh.vtu", "fields.vtu", "picture.svg"};
  std::ifstream in(folder / kRecord);
  const auto record = nlohmann::json::parse(in, nullptr, false);
  if (!record.is_object() || !record.contains("files")) return files;
  for (const auto& [name, mark] : record["files"].items())
    if (const fs::path file = fs::path(name).lexically_normal(); *file.begin() != ".." && file.is_relative())
      files.push_back(file);
  return files;
}

/// Temporary folders of this cell whose processes were killed.
void remove_unfinished(const fs::path& folder) {
  const std::string prefix = "." + folder.filename().string() + ".";
  std::error_code nothing_there;
  for (const auto& entry : fs::directory_iterator(folder.parent_path(), nothing_there)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(prefix) && name.ends_with(kTemporary)) fs::remove_all(entry.path(), nothing_there);
  }
}

void move_into_place(const fs::path& from, const fs::path& to) {
  if (!fs::exists(to) || (!fs::is_symlink(to) && fs::is_empty(to))) return fs::rename(from, to);
  for (const auto& entry : fs::directory_iterator(from))
    if (entry.path().filename() != kRecord) fs::rename(entry, to / entry.path().filename());
  fs::rename(from / kRecord, to / kRecord);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

}  // namespace

// The record first: it says that the rest is whole.
void remove_cell(const fs::path& folder) {
  const std::vector<fs::path> files = files_of_cell(folder);
  std::error_code nothing_there;
  fs::remove(folder / kRecord, nothing_there);
  for (const fs::path& file : files) fs::remove(folder / file, nothing_there);
}

void write_cell(const fs::path& folder, const std::function<void(const fs::path&)>& write) {
  const Uninterrupted whole;
  const std::string name =
      "." + folder.filename().string() + "." + std::to_string(process_number()) + kTemporary;
  const UnfinishedFolder temporary{folder.parent_path() / name};
  try {
    remove_cell(folder);
    remove_unfinished(folder);
    fs::create_directories(temporary.path);
    write(temporary.path);
    move_into_place(temporary.path, folder);
  } catch (const InputError& error) {
    throw InputError(replaced(error.what(), temporary.path.string(), folder.string()));
  } catch (const fs::filesystem_error& error) {
    throw InputError(folder.string() + ": cannot be written: " + error.code().message());
  }
}

void prepare_folder(const fs::path& folder) {
  std::error_code status;
  fs::create_directories(folder, status);
  if (!fs::is_directory(folder))
    refuse("{}: the folder cannot be made: {}", folder.string(), status.message());
  const TemporaryFolder probe(folder / ".delquad");
}

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
  if (file < 0) refuse("{}: cannot be written: {}", path.string(), std::generic_category().message(errno));
  files_.push_back(file);
  if (flock(file, (shared ? LOCK_SH : LOCK_EX) | LOCK_NB) == 0) return;
  if (errno != EWOULDBLOCK)
    refuse("{}: cannot be locked: {}", path.string(), std::generic_category().message(errno));
  throw InputError(path.parent_path().string() +
                   ": another run works on this folder: wait for it, or give another folder [folder-in-use]");
}

}  // namespace delquad
