#pragma once

#include <filesystem>
#include <functional>

#include "cad/cad_reader.h"
#include "cad/cad_shape.h"

namespace delquad::cad {

/// Reads, heals and triangulates a file's shape in a child process: on damaged files the kernel follows
/// broken references or runs in circles. Throws InputError.
CadShape prepare_shape(const std::filesystem::path& path, const CadOptions& options);

/// The same for a shape that `make` makes there.
CadShape prepare_shape(const std::function<CadShape()>& make, const CadOptions& options);

}  // namespace delquad::cad
