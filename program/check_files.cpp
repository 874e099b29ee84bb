#include "program/check_files.h"

#include <system_error>

#include "delquad/error.h"
#include "experiments/sweep/folders.h"
#include "io/mesh_io.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;

bool is_same(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::exists(a, error) && fs::exists(b, error))
    return fs::is_regular_file(a, error) && fs::equivalent(a, b, error);
  // Files that are still to be made.
  const auto full = [&](const fs::path& path) {
    return fs::weakly_canonical(fs::absolute(behind_links(path), error), error);
  };
  return full(a) == full(b);
}

}  // namespace

void check_output(const fs::path& path) {
  const fs::path target = behind_links(path);
  std::error_code error;
  if (fs::is_directory(target, error))
    throw InputError(path.string() + ": is a folder; expected a file to write");
  if (fs::exists(target, error) && !fs::is_regular_file(target, error))
    return;  // a device: no folder to check
  const fs::path folder = target.has_parent_path() ? target.parent_path() : ".";
  if (!fs::is_directory(folder, error))
    throw InputError(path.string() + ": there is no folder '" + folder.string() + "'");
  prepare_folder(folder);
}

void check_distinct(const std::vector<std::pair<std::string, fs::path>>& files) {
  for (std::size_t i = 0; i < files.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const auto& [role, path] = files[i];
      const auto& [other_role, other] = files[j];
      if (path.empty() || other.empty() || !is_same(path, other)) continue;
      throw InputError(role + " " + path.string() + ": is the same file as " + other_role + " " +
                       other.string());
    }
}

}  // namespace delquad
