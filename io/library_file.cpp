// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/library_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <optional>
#include <system_error>
#include <vector>

#include "base/located.h"
#include "base/process.h"
#include "base/system.h"
#include "base/text.h"
#include "delquad/error.h"
#include "io/mesh_io.h"

namespace delquad {

namespace {

[[noreturn]] void cannot_write(const std::filesystem::path& path, const std::string& why) {
  throw InputError(path.string() + ": cannot be written: " + why);
}

TemporaryFolder temporary_folder(const std::filesystem::path& path) {
  try {
    return TemporaryFolder();
  } catch (const InputError& error) {
    cannot_write(path, error.what());
  }
}

/// Returns the message of an exception of `work`; empty: it succeeded.
std::string error_of(const std::function<void()>& work) {
  errno = 0;
  try {
    work();
    return "";
  } catch (const std::exception& error) {
    return error.what();
  }
}

/// Does it in a process of its own. HDF5 cannot close a file after a failed write and crashes at the end of
/// the program for it, and MED prints pages about it. Throws InputError with what `work` threw there.
void do_in_child(const std::filesystem::path& path, const std::function<void()>& work) {
  std::optional<std::string> what_failed;
  try {
    what_failed = call_in_child([&] { return error_of(work); });
  } catch (const std::system_error& error) {
    cannot_write(path, error.code().message());
  }
  if (!what_failed) cannot_write(path, "the library that writes this format crashed");
  if (!what_failed->empty()) throw InputError(*what_failed);
}

}  // namespace

void copy_into(std::ostream& out, const std::filesystem::path& file) {
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  // Not by its buffer: operator<< forgets what the stream did not take.
  std::vector<char> block(1 << 16);
  while (in.read(block.data(), static_cast<std::streamsize>(block.size())), in.gcount() > 0)
    out.write(block.data(), in.gcount());
  if (!in.eof()) refuse("{}: {}", file.string(), cannot_be_read(std::generic_category().message(errno)));
}

std::function<void(std::ostream&)> by_library(
    const std::filesystem::path& path, std::function<void(const std::filesystem::path& temporary)> write) {
  return [path, name = "mesh" + path.extension().string(), write = std::move(write)](std::ostream& out) {
    const TemporaryFolder folder = temporary_folder(path);
    const std::filesystem::path temporary = folder.path() / name;
    do_in_child(path, [&] { write(temporary); });
    copy_into(out, temporary);
  };
}

void write_by_library(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write) {
  write_file_atomically(path, by_library(path, write));
}

void require_written(bool done, const std::filesystem::path& path, const std::string& library,
                     const char* what) {
  // Libraries may go on after what failed, and ask for this and that: only these are about disks.
  constexpr std::array kOfDisks = {ENOSPC, EDQUOT, EFBIG, EIO};
  const int error = errno;
  if (done) return;
  cannot_write(path, library + " could not write " + what + " into a temporary file in " +
                         std::filesystem::temp_directory_path().string() +
                         (std::ranges::find(kOfDisks, error) == kOfDisks.end()
                              ? ""
                              : ": " + std::generic_category().message(error)));
}

}  // namespace delquad
