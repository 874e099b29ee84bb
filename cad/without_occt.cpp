#include "cad/cad_reader.h"
#include "cad/example_models.h"
#include "mesh/error.h"

namespace delquad {

SurfaceModel read_cad(const std::filesystem::path& path, const CadOptions&) {
  throw InputError(path.string() + ": built without OpenCASCADE: cannot read STEP or BREP");
}

void write_example(const std::string& name, CadFormat, std::ostream&) {
  check_example(name);
  throw InputError("built without OpenCASCADE: cannot make the example '" + name + "'");
}

SurfaceModel read_example(const std::string& name, const CadOptions&) {
  check_example(name);
  throw InputError("built without OpenCASCADE: cannot make the example '" + name + "'");
}

}  // namespace delquad
