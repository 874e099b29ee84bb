// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/system.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <malloc.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/utsname.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <random>
#include <system_error>

#include "delquad/error.h"

namespace delquad {

namespace fs = std::filesystem;

fs::path running_program() {
  std::error_code unknown;
  return fs::read_symlink("/proc/self/exe", unknown);
}

fs::path file_of(void (*function)()) {
  Dl_info found = {};
  const bool known = dladdr(reinterpret_cast<void*>(function), &found) != 0 && found.dli_fname != nullptr;
  return known ? found.dli_fname : fs::path();
}

fs::path library_file(const std::string& file_name) {
  return file_of(&library_file).parent_path() / file_name;
}

const void* symbol_of_library(const std::string& file_name, const char* symbol) {
  const fs::path file = library_file(file_name);
  void* library = dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL);
  const void* found = library == nullptr ? nullptr : dlsym(library, symbol);
  if (found == nullptr) throw InputError(fmt::format("{}: cannot be loaded: {}", file.string(), dlerror()));
  return found;
}

bool can_be_run(const fs::path& file) {
  std::error_code unknown;
  return fs::is_regular_file(file, unknown) && access(file.c_str(), X_OK) == 0;
}

SystemNames system_names() {
  utsname names = {};
  uname(&names);
  SystemNames found{std::string(names.sysname) + " " + names.release, names.machine, ""};
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; found.processor.empty() && std::getline(in, line);)
    if (const auto at = line.find(": "); at != line.npos && line.starts_with("model name"))
      found.processor = line.substr(at + 2);
  return found;
}

std::optional<double> system_load() {
  double load = 0;
  return getloadavg(&load, 1) == 1 ? std::optional(load) : std::nullopt;
}

bool errors_have_a_terminal() { return isatty(STDERR_FILENO) != 0; }

long long peak_memory() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return 1024LL * usage.ru_maxrss;
}

void keep_freed_memory() {
#ifdef M_TRIM_THRESHOLD
  constexpr int kMebibyte = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, 32 * kMebibyte);  // largest allowed value
  mallopt(M_TRIM_THRESHOLD, 1024 * kMebibyte);
  mallopt(M_TOP_PAD, 16 * kMebibyte);
#endif
}

void use_huge_pages([[maybe_unused]] void* bytes, [[maybe_unused]] std::size_t size) noexcept {
#ifdef MADV_HUGEPAGE
  madvise(bytes, size, MADV_HUGEPAGE);
#endif
}

double coarse_seconds() noexcept {
  timespec t = {};
  clock_gettime(CLOCK_MONOTONIC_COARSE, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

ThreadClock clock_of_this_thread() noexcept {
  clockid_t clock = CLOCK_THREAD_CPUTIME_ID;
  pthread_getcpuclockid(pthread_self(), &clock);
  return clock;
}

long long nanoseconds_of(ThreadClock clock) noexcept {
  constexpr long long kTick = 1'000'000'000;
  timespec t = {};
  return clock_gettime(clock, &t) == 0 ? t.tv_sec * kTick + t.tv_nsec : 0;
}

long long nanoseconds_of_this_thread() noexcept { return nanoseconds_of(CLOCK_THREAD_CPUTIME_ID); }

namespace {

struct Task {
  const std::function<void()>& work;
  std::exception_ptr error;
};

void* run_task(void* argument) {
  Task& task = *static_cast<Task*>(argument);
  try {
    task.work();
  } catch (...) {
    task.error = std::current_exception();
  }
  return nullptr;
}

}  // namespace

void call_on_stack(std::size_t bytes, const std::function<void()>& work) {
  Task task{work, nullptr};
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  int error = pthread_attr_setstacksize(&attributes, bytes);
  pthread_t thread;
  if (error == 0) error = pthread_create(&thread, &attributes, run_task, &task);
  pthread_attr_destroy(&attributes);
  if (error != 0)
    throw std::system_error(error, std::generic_category(),
                            fmt::format("no thread with a stack of {} bytes", bytes));
  pthread_join(thread, nullptr);
  if (task.error) std::rethrow_exception(task.error);
}

TemporaryFolder::TemporaryFolder(const fs::path& begin) try {
  const fs::path first = begin.empty() ? fs::temp_directory_path() / "delquad" : begin;
  std::random_device random;
  do path_ = fmt::format("{}-{:08x}{:08x}", first.string(), random(), random());
  while (!fs::create_directory(path_));
  fs::permissions(path_, fs::perms::owner_all);
} catch (const fs::filesystem_error& error) {
  throw InputError(fmt::format("no temporary folder can be made{}: {}",
                               begin.empty() ? " (TMPDIR)" : " at " + begin.string(),
                               error.code().message()));
}

TemporaryFolder::~TemporaryFolder() {
  if (path_.empty()) return;
  const int error = errno;
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  errno = error;
}

}  // namespace delquad
