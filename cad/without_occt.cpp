#include "cad/cad_reader.h"
#include "mesh/error.h"

namespace delquad {

SurfaceModel read_cad(const std::filesystem::path& path, const CadOptions&) {
  throw InputError(path.string() + ": built without OpenCASCADE: cannot read STEP or BREP");
}

}  // namespace delquad
