#pragma once

#include <filesystem>

#include "cad/cad_shape.h"

namespace delquad::cad {

/// Reads STEP or BREP, by content; silences the kernel for good. Throws InputError without the name of the
/// file.
CadShape read_shape(const std::filesystem::path& path);

}  // namespace delquad::cad
