#include "pipeline/cell_folder.h"

#include <unistd.h>

#include <string>
#include <system_error>

#include "mesh/error.h"
#include "pipeline/interrupt.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;

/// Removed at the end unless it has been moved away.
struct TemporaryFolder {
  fs::path path;
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

/// What an earlier run left would pass for what this one made.
void remove_results(const fs::path& folder) {
  for (const char* name : {"mesh.msh", "mesh.vtu", "picture.svg", "convergence.svg", "record.json"}) {
    std::error_code nothing_there;
    fs::remove(folder / name, nothing_there);
  }
}

void move_into_place(const fs::path& from, const fs::path& to) {
  if (!fs::exists(to) || (!fs::is_symlink(to) && fs::is_empty(to))) return fs::rename(from, to);
  for (const auto& entry : fs::directory_iterator(from)) fs::rename(entry, to / entry.path().filename());
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

}  // namespace

void write_cell(const fs::path& folder, const std::function<void(const fs::path&)>& write) {
  const Uninterrupted whole;
  const std::string name = "." + folder.filename().string() + "." + std::to_string(getpid()) + ".tmp";
  const TemporaryFolder temporary{folder.parent_path() / name};
  try {
    remove_results(folder);
    fs::create_directories(temporary.path);
    write(temporary.path);
    move_into_place(temporary.path, folder);
  } catch (const InputError& error) {
    throw InputError(replaced(error.what(), temporary.path.string(), folder.string()));
  } catch (const fs::filesystem_error& error) {
    throw InputError(folder.string() + ": cannot be written: " + error.code().message());
  }
}

}  // namespace delquad
