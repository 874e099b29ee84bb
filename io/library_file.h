// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>
#include <utility>

// This header writes files by libraries of other projects, in separate processes. Their formats use it.

namespace delquad {

/// The number of an open file of a library; the destructor closes it.
template <class Id, auto close>
struct OpenFile {
  Id id = -1;

  OpenFile() = default;
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  ~OpenFile() {
    if (id >= 0) close(id);
  }
  operator Id() const { return id; }
  auto close_now() { return close(std::exchange(id, -1)); }
};

/// Copies a whole file. Throws InputError if it cannot be read; errors of the stream stay in its state.
void copy_into(std::ostream& out, const std::filesystem::path& file);

/// Returns a writer for formats whose library writes files by name. `write` fills a temporary file in a
/// separate process, which is then copied to the stream.
std::function<void(std::ostream&)> by_library(
    const std::filesystem::path& path, std::function<void(const std::filesystem::path& temporary)> write);
/// Writes a file by a library, whole or not at all, see write_file_atomically().
void write_by_library(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

/// Throws InputError if `done` is false. It names the file, the library and the failed step, and the reason
/// of the system for errors of disks.
void require_written(bool done, const std::filesystem::path& path, const std::string& library,
                     const char* what);

}  // namespace delquad
