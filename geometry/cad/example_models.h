// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ostream>
#include <string>

#include "geometry/cad/cad_reader.h"

// This header has the example models by name. The program, cases and tests use it.

namespace delquad {

/// Throws InputError, with the known names, if there is no example of this name.
void check_example(const std::string& name);

enum class CadFormat { kStep, kBrep };

/// Writes an example as a CAD file, in millimeters, the same bytes each time; names of faces are kept in STEP
/// only. Throws InputError for unknown names, and if the program was built without OpenCASCADE.
void write_example(const std::string& name, CadFormat format, std::ostream& out);

/// Returns an example as read_cad() reads its STEP file. Throws as write_example().
SurfaceModel read_example(const std::string& name, const CadOptions& options = {});

}  // namespace delquad
