#pragma once

#include <string>

#include "geometry/cad/cad_shape.h"

namespace delquad::cad {

/// A shape with its triangulation, names and warnings as bytes, exactly, and back.
std::string to_bytes(const CadShape& cad);
CadShape from_bytes(const std::string& bytes);

}  // namespace delquad::cad
