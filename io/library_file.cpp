#include "io/library_file.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <system_error>
#include <vector>

#include "base/located.h"
#include "delquad/error.h"
#include "io/mesh_io.h"

namespace delquad {

namespace {

[[noreturn]] void cannot_write(const std::filesystem::path& path, const std::string& why) {
  throw InputError(path.string() + ": cannot be written: " + why);
}

/// A new folder for what becomes the file at `path`, which goes with it.
class TemporaryHome {
 public:
  explicit TemporaryHome(const std::filesystem::path& path) {
    std::error_code error;
    std::string name = (std::filesystem::temp_directory_path(error) / "delquad-XXXXXX").string();
    if (!error && mkdtemp(name.data()) == nullptr) error = {errno, std::generic_category()};
    if (error) cannot_write(path, "there is no folder for temporary files (TMPDIR): " + error.message());
    folder_ = name;
  }
  /// errno stays: it tells why the stream failed.
  ~TemporaryHome() {
    const int error = errno;
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
    errno = error;
  }
  TemporaryHome(const TemporaryHome&) = delete;
  TemporaryHome& operator=(const TemporaryHome&) = delete;
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

/// What `work` throws; empty: it was done.
std::string trouble_of(const std::function<void()>& work) {
  errno = 0;
  try {
    work();
    return "";
  } catch (const std::exception& error) {
    return error.what();
  }
}

/// Does it in a process of its own: HDF5 cannot close a file after a failed write and crashes at the end of
/// the program for it, and MED prints pages about it. Throws InputError with what `work` threw there.
void do_apart(const std::filesystem::path& path, const std::function<void()>& work) {
  constexpr char kDone = '\n';  // a line that the child alone can end
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) cannot_write(path, std::generic_category().message(errno));
  const pid_t child = fork();
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    const std::string told = trouble_of(work) + kDone;
    _exit(write(ends[1], told.data(), told.size()) < 0);
  }
  const int error = errno;
  close(ends[1]);
  std::string told;
  std::array<char, 4096> block;
  ssize_t n = 0;
  while ((n = read(ends[0], block.data(), block.size())) > 0 || (n < 0 && errno == EINTR))
    told.append(block.data(), static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
  close(ends[0]);
  if (child < 0) cannot_write(path, std::generic_category().message(error));
  while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
  }
  if (!told.ends_with(kDone)) cannot_write(path, "the library that writes it crashed");
  told.pop_back();
  if (!told.empty()) throw InputError(told);
}

}  // namespace

void copy_into(std::ostream& out, const std::filesystem::path& file) {
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  // Not by its buffer: operator<< forgets what the stream did not take.
  std::vector<char> block(1 << 16);
  while (in.read(block.data(), static_cast<std::streamsize>(block.size())), in.gcount() > 0)
    out.write(block.data(), in.gcount());
  if (!in.eof()) refuse("{}: cannot be read: {}", file.string(), std::generic_category().message(errno));
}

std::function<void(std::ostream&)> by_library(
    const std::filesystem::path& path, std::function<void(const std::filesystem::path& temporary)> write) {
  return [path, name = "mesh" + path.extension().string(), write = std::move(write)](std::ostream& out) {
    const TemporaryHome home(path);
    const std::filesystem::path temporary = home.folder() / name;
    do_apart(path, [&] { write(temporary); });
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
