// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>
#include <utility>

// This header writes files by libraries of others, in processes of their own. Their formats use it.

namespace delquad {

/// The number that a library gives to an open file, which is closed at the end.
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

/// Copies all of a file. Throws InputError where it cannot be read; what the stream does not take is left to
/// its state.
void copy_into(std::ostream& out, const std::filesystem::path& file);

/// Returns a writer for formats whose library writes files by their name. `write` fills a temporary one in a
/// process of its own, which is then copied to the stream.
std::function<void(std::ostream&)> by_library(
    const std::filesystem::path& path, std::function<void(const std::filesystem::path& temporary)> write);
/// Writes a file by a library, whole or not at all, see write_file_atomically().
void write_by_library(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

/// Throws InputError if `done` is false. It names the file, the library, the failed step, and the system's
/// reason where it is one of disks.
void require_written(bool done, const std::filesystem::path& path, const std::string& library,
                     const char* what);

}  // namespace delquad
