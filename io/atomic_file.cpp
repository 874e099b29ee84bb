// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <list>
#include <mutex>
#include <string>
#include <system_error>
#include <utility>

#include "base/process.h"
#include "delquad/error.h"
#include "io/mesh_io.h"
#include "io/text_writer.h"

namespace delquad {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path& path, int error) {
  throw InputError(path.string() + ": cannot be written: " +
                   (error != 0 ? std::generic_category().message(error) : "the output stream failed"));
}

void write_stream(const fs::path& path, const fs::path& shown,
                  const std::function<void(std::ostream&)>& write) {
  errno = 0;
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  if (!out) fail(shown, errno);
  out.exceptions(std::ios::badbit | std::ios::failbit);
  try {
    errno = 0;
    write(out);
    out.close();
  } catch (const std::ios_base::failure&) {
    fail(shown, errno);
  }
}

/// Paths of the files that are being written, where a signal handler finds them: no memory that moves.
struct UnfinishedFile {
  std::atomic<bool> taken{false}, filled{false};
  char path[4096];
};
std::array<UnfinishedFile, 8> unfinished_files;  // some threads may write at a time

/// Held while a file gets its place, and by who ends the process for good.
std::mutex placing;
bool any_placed = false;

/// Removes the file unless it has been moved away.
class TemporaryFile {
 public:
  explicit TemporaryFile(fs::path path) : path_(std::move(path)) {
    for (UnfinishedFile& file : unfinished_files) {
      if (path_.native().size() >= sizeof file.path || file.taken.exchange(true)) continue;
      std::strcpy(file.path, path_.c_str());
      file.filled = true;
      listed_ = &file;
      break;
    }
  }
  ~TemporaryFile() {
    std::error_code ignored;
    fs::remove(path_, ignored);
    if (listed_ == nullptr) return;
    listed_->filled = false;
    listed_->taken = false;
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
  UnfinishedFile* listed_ = nullptr;
};

}  // namespace

void remove_unfinished_files() noexcept {
  for (const UnfinishedFile& file : unfinished_files)
    if (file.filled) std::remove(file.path);
}

bool abandon_files() {
  placing.lock();
  if (any_placed) {
    placing.unlock();
    return false;
  }
  remove_unfinished_files();
  return true;
}

fs::path behind_links(fs::path path) {
  constexpr int kMostLinks = 40;  // as in the kernel
  const fs::path given = path;
  std::error_code error;
  for (int links = 0; fs::is_symlink(path, error); ++links) {
    if (links == kMostLinks) fail(given, ELOOP);
    path = path.parent_path() / fs::read_symlink(path, error);  // an absolute target replaces the folder
  }
  return path;
}

void write_file_atomically(const fs::path& path, const std::function<void(std::ostream&)>& write) {
  write_files_atomically({{path, write}});
}

void write_text_file(const fs::path& path, std::string_view text) {
  write_file_atomically(path, [&](std::ostream& out) { out << text; });
}

void write_text_file(const fs::path& path, const std::function<void(TextWriter&)>& write) {
  write_file_atomically(path, as_text(write));
}

void write_files_atomically(const std::vector<FileToWrite>& files) {
  std::list<TemporaryFile> filled;
  std::vector<std::pair<fs::path, fs::path>> targets;  // as given, and behind links
  std::error_code error;
  for (const auto& [path, write] : files) {
    const fs::file_status status = fs::status(path, error);
    if (fs::is_directory(status)) throw InputError(path.string() + ": cannot be written: it is a folder");
    // A device or pipe must not be replaced by a file.
    if (fs::exists(status) && !fs::is_regular_file(status)) {
      write_stream(path, path, write);
      continue;
    }
    // A link stays; what it points to is replaced.
    const fs::path target = behind_links(path);
    constexpr size_t kLongestStem = 200;  // of the 255 characters that file systems allow
    const std::string stem = target.filename().string().substr(0, kLongestStem);
    const std::string name = "." + stem + "." + std::to_string(process_number()) + ".tmp";
    filled.emplace_back(target.parent_path() / name);
    write_stream(filled.back().path(), path, write);
    targets.emplace_back(path, target);
  }
  const std::lock_guard lock(placing);
  auto file = filled.begin();
  for (const auto& [path, target] : targets) {
    fs::rename((file++)->path(), target, error);
    if (error) fail(path, error.value());
    any_placed = true;
  }
}

}  // namespace delquad
