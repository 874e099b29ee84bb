// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ostream>
#include <string>

#include "delquad/model.h"
#include "geometry/cad/example_models.h"
#include "geometry/surface/surface_model.h"

// This header loads the library that needs OpenCASCADE. Callers outside of this module do not see it.

namespace delquad::cad {

/// The library with the functions of this module that need OpenCASCADE. It is loaded when the first of them
/// is called.
inline constexpr const char* kKernelLibrary = "libdelquad-kernel.so";

/// Its functions: read_cad(), read_example() and write_example().
struct Kernel {
  SurfaceModel (*read_cad)(const CadModel&, const CadOptions&);
  SurfaceModel (*read_example)(const std::string&, const CadOptions&);
  void (*write_example)(const std::string&, CadFormat, std::ostream&);
};

/// The implementations of the three, in this library. They do not check the name of an example.
SurfaceModel read_by_kernel(const CadModel& model, const CadOptions& options);
SurfaceModel read_example_by_kernel(const std::string& name, const CadOptions& options);
void write_example_by_kernel(const std::string& name, CadFormat format, std::ostream& out);

}  // namespace delquad::cad
