// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// This header runs the bench: experiments, reports and the program, above the library. Programs that link
// delquad::bench (package component "bench") use it.

namespace delquad {

/// Runs the `delquad` program with all additions, see extend.h. Returns its exit code (README.md); errors are
/// printed, not thrown.
int run_program(int argc, char** argv);

}  // namespace delquad
