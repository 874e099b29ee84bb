#pragma once

#include <filesystem>
#include <string>

#include "geometry/cad/cad_shape.h"

namespace delquad::cad {

/// Reads STEP or BREP, by content; silences the kernel for good. Throws InputError without the name of the
/// file.
CadShape read_shape(const std::filesystem::path& path);
/// The same from the contents of such a file.
CadShape read_shape_bytes(const std::string& bytes);

}  // namespace delquad::cad
