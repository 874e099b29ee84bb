#include "experiments/sweep/command_files.h"

#include <system_error>

#include "io/digest.h"

namespace delquad {

namespace fs = std::filesystem;

fs::path file_of_word(const fs::path& folder, const std::vector<std::string>& words, std::size_t i) {
  const std::string& word = words[i];
  if (i == 0 && word.find('/') == std::string::npos) return {};
  if (word.empty() || word.find('{') != std::string::npos) return {};
  std::error_code nothing_there;
  const fs::path file = fs::absolute(folder / word).lexically_normal();
  return fs::is_regular_file(file, nothing_there) ? file : fs::path();
}

std::map<std::string, std::string> command_files(const fs::path& folder,
                                                 const std::vector<std::string>& words) {
  std::map<std::string, std::string> digests;
  for (std::size_t i = 0; i < words.size(); ++i)
    if (const fs::path file = file_of_word(folder, words, i); !file.empty())
      digests[words[i]] = file_digest(file);
  return digests;
}

}  // namespace delquad
