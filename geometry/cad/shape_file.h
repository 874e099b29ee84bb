#pragma once

#include <filesystem>
#include <string>

#include "geometry/cad/cad_shape.h"

namespace delquad::cad {

/// Reads STEP, IGES or BREP, by content, lengths in `unit` (see CadOptions); silences the kernel for good.
/// Throws InputError without the name of the file.
CadShape read_shape(const std::filesystem::path& path, const std::string& unit);
/// The same from the contents of such a file.
CadShape read_shape_bytes(const std::string& bytes, const std::string& unit);

}  // namespace delquad::cad
