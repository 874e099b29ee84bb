#include <dlfcn.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <mutex>
#include <system_error>
#include <vector>

#include "delquad/error.h"
#include "delquad/model.h"
#include "geometry/cad/cad_reader.h"
#include "geometry/cad/worker_process.h"

namespace delquad {

namespace {

namespace fs = std::filesystem;

constexpr const char* kName = "delquad-cad";
constexpr const char* kVariable = "DELQUAD_CAD_WORKER";

/// What the program around has said, once for all its threads.
struct Chosen {
  std::mutex mutex;
  fs::path program;
};
Chosen& chosen() {
  static Chosen one;
  return one;
}

bool is_program(const fs::path& path) {
  std::error_code unknown;
  return fs::is_regular_file(path, unknown) && access(path.c_str(), X_OK) == 0;
}

/// One that was asked for is taken or refused; there is no other in its place.
fs::path required(const fs::path& path, const std::string& who) {
  if (is_program(path)) return path;
  throw InputError(
      fmt::format("{} says that {} reads CAD files: that is no program that can be run", who, path.string()));
}

/// Folders in which it is looked for: that of the running program, and where it is installed, as seen from
/// the program or library that this code is in.
std::vector<fs::path> folders() {
  std::vector<fs::path> all;
  std::error_code unknown;
  const fs::path program = fs::read_symlink("/proc/self/exe", unknown).parent_path();
  if (!program.empty()) {
    all.push_back(program);
    all.push_back((program / DELQUAD_LIBEXEC_FROM_BIN).lexically_normal());
  }
  Dl_info here = {};
  if (dladdr(reinterpret_cast<void*>(&chosen), &here) != 0 && here.dli_fname != nullptr)
    all.push_back(
        (fs::absolute(here.dli_fname, unknown).parent_path() / DELQUAD_LIBEXEC_FROM_LIB).lexically_normal());
  all.emplace_back(DELQUAD_LIBEXEC);
  return all;
}

}  // namespace

void set_cad_worker(const fs::path& program) {
  const std::lock_guard lock(chosen().mutex);
  chosen().program = program;
}

fs::path cad::find_worker() {
  if (const char* variable = std::getenv(kVariable); variable != nullptr && *variable != 0)
    return required(variable, kVariable);
  {
    const std::lock_guard lock(chosen().mutex);
    if (!chosen().program.empty()) return required(chosen().program, "set_cad_worker()");
  }
  std::string places;
  for (const fs::path& folder : folders()) {
    if (is_program(folder / kName)) return folder / kName;
    places += (places.empty() ? "" : ", ") + folder.string();
  }
  throw InputError(
      fmt::format("the program {}, which reads CAD files, is not there: expected it in one of {}, "
                  "or named by {}",
                  kName, places, kVariable));
}

fs::path cad_program() {
  try {
    return cad::find_worker();
  } catch (const InputError&) {
    return {};
  }
}

}  // namespace delquad
