// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ostream>
#include <string>

#include "delquad/model.h"
#include "geometry/cad/example_models.h"
#include "geometry/surface/surface_model.h"

// This header loads the library that needs OpenCASCADE. Only this module uses it.

namespace delquad::cad {

/// File names of the libraries that need OpenCASCADE: one reads models, the other has the examples, which
/// need more of it. The first call of a function loads its library.
inline constexpr const char *kKernelLibrary = "libdelquad-kernel.so",
                            *kExamplesLibrary = "libdelquad-examples.so";

/// Functions of the libraries: read_cad(), read_example() and write_example().
struct Kernel {
  SurfaceModel (*read_cad)(const CadModel&, const CadOptions&);
};
struct ExampleKernel {
  SurfaceModel (*read_example)(const std::string&, const CadOptions&);
  void (*write_example)(const std::string&, CadFormat, std::ostream&);
};

/// Implement these functions in the libraries. The name of an example must exist.
SurfaceModel read_by_kernel(const CadModel& model, const CadOptions& options);
SurfaceModel read_example_by_kernel(const std::string& name, const CadOptions& options);
void write_example_by_kernel(const std::string& name, CadFormat format, std::ostream& out);

}  // namespace delquad::cad
