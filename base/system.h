#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>

// What the standard library does not tell of the system, or does not do by it: all of it stands here and in
// process.h.

namespace delquad {

/// The file of the running program; empty where it is not known.
std::filesystem::path running_program();
/// The library or program that holds a function, as it was loaded: for a program perhaps without its folder.
/// Empty where it is not known.
std::filesystem::path file_of(void (*function)());
template <class F>
std::filesystem::path file_of(F* function) {
  return file_of(reinterpret_cast<void (*)()>(function));
}
/// One of this project's libraries, which lies beside the library that this code is in.
std::filesystem::path library_file(const std::string& file_name);
/// A symbol of such a library, which is loaded and stays for good. Throws InputError that names the file and
/// the system's reason.
const void* symbol_of_library(const std::string& file_name, const char* symbol);
/// Whether this process may run it.
bool can_be_run(const std::filesystem::path& file);

/// What the program runs on, such as "Linux 6.1", "x86_64" and the model of its processor; empty where it is
/// not told.
struct SystemNames {
  std::string system, architecture, processor;
};
SystemNames system_names();
/// Average number of processes that ran or waited to, over the last minute.
std::optional<double> system_load();

/// Whether the standard error is a terminal.
bool errors_have_a_terminal();

/// The most memory that this process has held so far, in bytes.
long long peak_memory();
/// Large arrays come and go in every step: giving them back to the system each time costs 3 to 5 % of a run.
void keep_freed_memory();
constexpr std::size_t kHugePage = std::size_t{1} << 21;
/// A hint that these bytes, which begin at a huge page, are read in no order.
void use_huge_pages(void* bytes, std::size_t size) noexcept;

/// Seconds, exact to some milliseconds, of a clock that is several times as fast as the steady one.
double coarse_seconds() noexcept;
/// The clock of this thread's work, which other threads may read, too, as long as this one lives.
using ThreadClock = int;
ThreadClock clock_of_this_thread() noexcept;
/// In nanoseconds; 0 where it does not run any more.
long long nanoseconds_of(ThreadClock clock) noexcept;
long long nanoseconds_of_this_thread() noexcept;

/// Calls it in a thread with a stack of this many bytes, waits, and throws what it threw.
void call_on_stack(std::size_t bytes, const std::function<void()>& work);

/// A new folder for nobody else, removed at the end with what it holds.
class TemporaryFolder {
 public:
  /// Its path begins so; default: where the system has its temporary files. Throws InputError when it cannot
  /// be made.
  explicit TemporaryFolder(const std::filesystem::path& begin = {});
  TemporaryFolder(TemporaryFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  TemporaryFolder& operator=(TemporaryFolder&&) = delete;
  /// errno stays: it may tell why a stream in it failed.
  ~TemporaryFolder();
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace delquad
