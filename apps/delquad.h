#pragma once

namespace delquad {

/// The `delquad` program: what its arguments ask for. Returns its exit code; errors are printed.
int run_program(int argc, char** argv);

}  // namespace delquad
