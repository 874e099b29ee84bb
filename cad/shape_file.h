#pragma once

#include <filesystem>

#include "cad/cad_shape.h"

namespace delquad::cad {

/// Reads STEP or BREP, by content. Throws InputError naming the file.
CadShape read_shape(const std::filesystem::path& path);

}  // namespace delquad::cad
