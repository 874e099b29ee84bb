#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace delquad {

/// The file beside the experiment, in `folder`, that word `i` of a command stands for; empty: none. A program
/// without a slash is one of the PATH, whatever lies beside the experiment.
std::filesystem::path file_of_word(const std::filesystem::path& folder, const std::vector<std::string>& words,
                                   std::size_t i);

/// The words of a command that stand for files, with the digests of these.
std::map<std::string, std::string> command_files(const std::filesystem::path& folder,
                                                 const std::vector<std::string>& words);

}  // namespace delquad
