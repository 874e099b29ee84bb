// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/kernel.h"

/// The symbol that load_kernel.cpp looks for.
extern "C" __attribute__((visibility("default"))) const delquad::cad::ExampleKernel delquad_examples = {
    delquad::cad::read_example_by_kernel, delquad::cad::write_example_by_kernel};
