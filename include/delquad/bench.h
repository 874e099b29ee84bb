#pragma once

// The bench: experiments, reports and the program, on top of the library. Component "bench" of the
// package, target delquad::bench.

namespace delquad {

/// The `delquad` program with what was added, see extend.h: what its arguments ask for. Returns its exit
/// code; errors are printed.
int run_program(int argc, char** argv);

}  // namespace delquad
