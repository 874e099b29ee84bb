// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "geometry/cad/cad_worker.h"

/// Runs a worker for the library, with the library's process number and a socket as standard input. A user
/// can ask for the version of OpenCASCADE.
int main(int argc, char** argv) {
  constexpr int kInput = 0;
  if (argc != 2) return EXIT_FAILURE;
  if (std::strcmp(argv[1], "--version") == 0)
    return std::puts(delquad::cad::kernel_version().c_str()) < 0 ? EXIT_FAILURE : EXIT_SUCCESS;
  delquad::cad::run_worker(kInput, std::atoi(argv[1]));
}
