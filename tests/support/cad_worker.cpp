#include <cstdlib>

// Part of every test program: the library finds the program that reads CAD, wherever the test lies.
namespace {
[[maybe_unused]] const int is_set = setenv("DELQUAD_CAD_WORKER", DELQUAD_CAD_PROGRAM, /*overwrite=*/0);
}  // namespace
