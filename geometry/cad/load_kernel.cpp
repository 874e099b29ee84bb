// SPDX-License-Identifier: GPL-3.0-or-later
#include <system_error>

#include "base/system.h"
#include "delquad/error.h"
#include "geometry/cad/cad_reader.h"
#include "geometry/cad/kernel.h"

namespace delquad {

namespace {

/// Returns the functions of a library. Throws InputError with `refusal` if the program was built without
/// OpenCASCADE.
template <class Functions>
const Functions& load([[maybe_unused]] const char* library, [[maybe_unused]] const char* symbol,
                      [[maybe_unused]] const std::string& refusal) {
#ifdef DELQUAD_HAS_CAD
  static const auto* loaded = static_cast<const Functions*>(symbol_of_library(library, symbol));
  return *loaded;
#else
  throw InputError(refusal);
#endif
}

const cad::ExampleKernel& examples(const std::string& name) {
  check_example(name);
  return load<cad::ExampleKernel>(cad::kExamplesLibrary, "delquad_examples",
                                  "built without OpenCASCADE: cannot make the example '" + name + "'");
}

}  // namespace

std::filesystem::path cad_library() {
  const std::filesystem::path file = library_file(cad::kKernelLibrary);
  std::error_code unknown;
  return std::filesystem::exists(file, unknown) ? file : std::filesystem::path();
}

SurfaceModel read_cad(const CadModel& model, const CadOptions& options) {
  return load<cad::Kernel>(cad::kKernelLibrary, "delquad_kernel",
                           model.file.string() + ": built without OpenCASCADE: cannot read STEP or BREP")
      .read_cad(model, options);
}

SurfaceModel read_cad(const std::filesystem::path& path, const CadOptions& options) {
  return read_cad(CadModel{path}, options);
}

SurfaceModel read_example(const std::string& name, const CadOptions& options) {
  return examples(name).read_example(name, options);
}

void write_example(const std::string& name, CadFormat format, std::ostream& out) {
  examples(name).write_example(name, format, out);
}

}  // namespace delquad
