#pragma once

#include "delquad/mesher.h"

namespace delquad {

/// How good the maps of a surface are, how it was cut and how the mesh fits it, to stdout.
void print_surface_report(const Prepared& prepared, const SurfaceReport& report);

}  // namespace delquad
