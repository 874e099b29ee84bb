#pragma once

#include <pybind11/pybind11.h>

namespace delquad::python {

/// HexMesh, and extrude() for each way.
void define_hexahedra(pybind11::module_& m);

}  // namespace delquad::python
