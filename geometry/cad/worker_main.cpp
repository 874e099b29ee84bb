#include <cstdlib>

#include "geometry/cad/cad_worker.h"

/// Started by the library, with its own process number and a socket as standard input; of no use to people.
int main(int argc, char** argv) {
  constexpr int kInput = 0;
  if (argc != 2) return EXIT_FAILURE;
  delquad::cad::work_for(kInput, std::atoi(argv[1]));
}
