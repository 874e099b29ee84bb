// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/failing_disk.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <ctime>

namespace {

/// In memory that children share.
struct Plan {
  std::atomic<bool> armed{false};
  std::atomic<long long> room{-1}, failing{0};  // -1: as much as one likes; 0: none
  std::atomic<long long> calls{0}, bytes{0};
};

Plan& plan() {
  static Plan* const shared =
      new (mmap(nullptr, sizeof(Plan), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) Plan;
  return *shared;
}

bool is_watched(int file) {
  struct stat status {};
  return plan().armed && fstat(file, &status) == 0 && S_ISREG(status.st_mode) &&
         (fcntl(file, F_GETFL) & O_ACCMODE) != O_RDONLY;
}

/// Whether a call on the file fails, and then sets errno.
bool fails(int file) {
  if (!is_watched(file) || ++plan().calls != plan().failing) return false;
  errno = EDQUOT;
  return true;
}

/// The part of so many bytes that the disk has room for; -1: none, and sets errno.
long long taken(int file, std::size_t wanted) {
  if (!is_watched(file)) return static_cast<long long>(wanted);
  if (fails(file)) return -1;
  long long n = static_cast<long long>(wanted);
  if (plan().room >= 0) n = std::min(n, plan().room - plan().bytes);
  if (n <= 0 && wanted > 0) {
    errno = ENOSPC;
    return -1;
  }
  plan().bytes += n;
  return n;
}

}  // namespace

namespace delquad::testing_support {

FailingDisk::FailingDisk(long long room, long long call) {
  plan().calls = plan().bytes = 0;
  plan().room = room;
  plan().failing = call;
  plan().armed = true;
}
FailingDisk::~FailingDisk() { plan().armed = false; }
long long FailingDisk::calls() const { return plan().calls; }
long long FailingDisk::bytes() const { return plan().bytes; }

}  // namespace delquad::testing_support

// In place of the C library's, for all libraries of the program.
extern "C" {

ssize_t write(int file, const void* data, std::size_t size) {
  const long long n = taken(file, size);
  return n < 0 ? -1 : syscall(SYS_write, file, data, n);
}

ssize_t pwrite64(int file, const void* data, std::size_t size, off64_t at) {
  const long long n = taken(file, size);
  return n < 0 ? -1 : syscall(SYS_pwrite64, file, data, n, at);
}
ssize_t pwrite(int file, const void* data, std::size_t size, off_t at) {
  return pwrite64(file, data, size, at);
}

ssize_t writev(int file, const iovec* parts, int count) {
  std::size_t size = 0;
  for (int i = 0; i < count; ++i) size += parts[i].iov_len;
  const long long n = taken(file, size);
  if (n == static_cast<long long>(size)) return syscall(SYS_writev, file, parts, count);
  return n < 0 ? -1 : syscall(SYS_write, file, parts[0].iov_base, std::min<std::size_t>(n, parts[0].iov_len));
}

int ftruncate64(int file, off64_t size) {
  return fails(file) ? -1 : static_cast<int>(syscall(SYS_ftruncate, file, size));
}
int ftruncate(int file, off_t size) { return ftruncate64(file, size); }

int fsync(int file) { return fails(file) ? -1 : static_cast<int>(syscall(SYS_fsync, file)); }

int close(int file) {
  const bool failed = fails(file);
  const int error = errno, closed = static_cast<int>(syscall(SYS_close, file));
  if (failed) errno = error;
  return failed ? -1 : closed;
}

/// HDF5 writes when it made an object: always at once, so that files can be compared.
int gettimeofday(timeval* time, void*) noexcept {
  timespec now{};
  if (!plan().armed) syscall(SYS_clock_gettime, CLOCK_REALTIME, &now);
  *time = {now.tv_sec, now.tv_nsec / 1000};
  return 0;
}

int fclose(FILE* file) {
  static const auto original = reinterpret_cast<int (*)(FILE*)>(dlsym(RTLD_NEXT, "fclose"));
  const bool failed = fails(fileno(file));
  const int error = errno, closed = original(file);
  if (failed) errno = error;
  return failed ? EOF : closed;
}
}
