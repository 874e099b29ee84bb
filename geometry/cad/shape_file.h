// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "geometry/cad/cad_reader.h"
#include "geometry/cad/cad_shape.h"

// This header reads CAD files as shapes. The worker uses it.

namespace delquad::cad {

/// Returns the shape of a STEP, IGES or BREP file, told apart by content. The kernel prints nothing from then
/// on. Throws InputError, without the name of the file, if a part cannot be read, unless options.keep_going
/// leaves it out.
CadShape read_shape(const std::filesystem::path& path, const CadOptions& options);
/// Returns the same from the contents of such a file.
CadShape read_shape_bytes(const std::string& bytes, const CadOptions& options);

/// Returns a shape with its triangulation, names and warnings as bytes, without loss.
std::string to_bytes(const CadShape& cad);
/// Returns the shape of such bytes. Throws InputError if they are incomplete.
CadShape from_bytes(const std::string& bytes);

}  // namespace delquad::cad
