// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/kernel.h"

/// The symbol that load_kernel.cpp looks for.
extern "C" __attribute__((visibility("default")))
const delquad::cad::Kernel delquad_kernel = {delquad::cad::read_by_kernel};
