#include "io/library_file.h"

#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <system_error>

#include "delquad/error.h"
#include "io/mesh_io.h"

namespace delquad {

namespace {

/// A new folder for a file, which goes with it.
class TemporaryHome {
 public:
  TemporaryHome() {
    std::string name = (std::filesystem::temp_directory_path() / "delquad-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw InputError(name + ": cannot be made: " + std::generic_category().message(errno));
    folder_ = name;
  }
  ~TemporaryHome() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  TemporaryHome(const TemporaryHome&) = delete;
  TemporaryHome& operator=(const TemporaryHome&) = delete;
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

}  // namespace

std::function<void(std::ostream&)> by_library(
    const std::filesystem::path& path, std::function<void(const std::filesystem::path& temporary)> write) {
  return [name = "mesh" + path.extension().string(), write = std::move(write)](std::ostream& out) {
    const TemporaryHome home;
    write(home.folder() / name);
    out << std::ifstream(home.folder() / name, std::ios::binary).rdbuf();
  };
}

void write_by_library(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write) {
  write_file_atomically(path, by_library(path, write));
}

void require_written(bool done, const std::filesystem::path& path, const std::string& library,
                     const char* what) {
  if (!done) throw InputError(path.string() + ": cannot be written: " + library + " could not write " + what);
}

void refuse_without_library(const std::filesystem::path& path, const std::string& package) {
  throw InputError(path.string() + ": this program was built without the library for '" +
                   path.extension().string() + "': install Debian's package " + package +
                   " and build it again");
}

}  // namespace delquad
