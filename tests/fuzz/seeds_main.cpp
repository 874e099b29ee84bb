// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>

#include "tests/fuzz/target.h"

/// Writes the seeds of this program's targets to FOLDER/TARGET/seed_N and prints the targets' names, each
/// with the number of bytes of its longest input.
int main(int argc, char** argv) try {
  if (argc != 2) throw std::runtime_error("usage: seeds FOLDER");
  for (const auto& target : delquad::fuzz::DELQUAD_FUZZ_TARGETS()) {
    const std::filesystem::path folder = std::filesystem::path(argv[1]) / target.name;
    std::filesystem::create_directories(folder);
    int number = 0;
    for (const std::string& seed : target.seeds()) {
      std::ofstream out(folder / ("seed_" + std::to_string(++number)), std::ios::binary);
      out << seed;
      if (!out.flush()) throw std::runtime_error(folder.string() + ": cannot be written");
    }
    std::printf("%s %d\n", target.name.c_str(), target.longest);
  }
  return EXIT_SUCCESS;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return EXIT_FAILURE;
}
