#include "experiments/sweep/scratch_folder.h"

#include <cstdlib>
#include <string>
#include <system_error>

#include "delquad/error.h"

namespace delquad {

namespace fs = std::filesystem;

ScratchFolder::ScratchFolder(std::string pattern) {
  if (mkdtemp(pattern.data()) == nullptr) throw InputError(pattern + ": cannot be made");
  path_ = pattern;
}

ScratchFolder::ScratchFolder() : ScratchFolder((fs::temp_directory_path() / "delquad-XXXXXX").string()) {}

ScratchFolder::ScratchFolder(const fs::path& target)
    : ScratchFolder(
          (fs::absolute(target).parent_path() / ("." + target.filename().string() + "-XXXXXX")).string()) {}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace delquad
