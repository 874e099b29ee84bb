// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>

// This header asks the system for facts that the standard library lacks. All system calls are here and in
// process.h.

namespace delquad {

/// Returns the file of the running program; empty: unknown.
std::filesystem::path running_program();
/// Returns the library or program with a function, as loaded: a program may lack its folder. Empty: unknown.
std::filesystem::path file_of(void (*function)());
template <class F>
std::filesystem::path file_of(F* function) {
  return file_of(reinterpret_cast<void (*)()>(function));
}
/// Returns the path of a library of this project, beside the library with this code; it need not exist.
std::filesystem::path library_file(const std::string& file_name);
/// Returns a symbol of such a library, which is loaded and stays. Throws InputError, with the file and the
/// system's reason, if it cannot be loaded or lacks the symbol.
const void* symbol_of_library(const std::string& file_name, const char* symbol);
/// Returns whether this process may run the file.
bool can_be_run(const std::filesystem::path& file);

/// System, such as "Linux 6.1", architecture "x86_64", and processor model; empty: unknown.
struct SystemNames {
  std::string system, architecture, processor;
};
SystemNames system_names();
/// Returns the average number of running and waiting processes over the last minute; nothing if unknown.
std::optional<double> system_load();

/// Returns whether standard error is a terminal.
bool errors_have_a_terminal();

/// Returns the largest memory of this process so far, in bytes.
long long peak_memory();
/// Keeps freed memory for large arrays of the next step. Returning it to the system costs 3 to 5 % of a run.
void keep_freed_memory();
constexpr std::size_t kHugePage = std::size_t{1} << 21;
/// Hints that these bytes, which start at a multiple of kHugePage bytes, are read in random order.
void use_huge_pages(void* bytes, std::size_t size) noexcept;

/// Returns the seconds of a monotonic clock, to some milliseconds. It is several times as fast to read as
/// std::steady_clock.
double coarse_seconds() noexcept;
/// Clock of a thread's processor time. Other threads may read it while the thread lives.
using ThreadClock = int;
ThreadClock clock_of_this_thread() noexcept;
/// Returns the nanoseconds of processor time; 0 if the thread has ended.
long long nanoseconds_of(ThreadClock clock) noexcept;
long long nanoseconds_of_this_thread() noexcept;

/// Calls work in a thread with a stack of this size, waits, and throws its exception. Throws
/// std::system_error if no such thread can start.
void call_on_stack(std::size_t bytes, const std::function<void()>& work);

/// A new private folder, removed at the end with its content.
class TemporaryFolder {
 public:
  /// Adds random digits to `begin`; default: in the system's folder of temporary files. Throws InputError if
  /// it cannot be made.
  explicit TemporaryFolder(const std::filesystem::path& begin = {});
  TemporaryFolder(TemporaryFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  TemporaryFolder& operator=(TemporaryFolder&&) = delete;
  /// Keeps errno, which may tell why a stream in the folder failed.
  ~TemporaryFolder();
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace delquad
