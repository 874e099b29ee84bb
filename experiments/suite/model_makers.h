#pragma once

#include <string>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// What makes a model of the suite. Coordinates have nine digits after the point.
template <class Made>
struct SuiteMaker {
  const char* name;
  Made (*make)();
};

/// The texts of model files (docs/models.md) without a size.
const std::vector<SuiteMaker<std::string>>& planar_suite_models();
/// Points and triangles only, outward where they are closed.
const std::vector<SuiteMaker<Mesh>>& triangle_suite_models();

}  // namespace delquad
