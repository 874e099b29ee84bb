#include "delquad/error.h"
#include "geometry/cad/cad_reader.h"
#include "geometry/cad/example_models.h"

namespace delquad {

void set_cad_worker(const std::filesystem::path&) {}

SurfaceModel read_cad(const CadModel& model, const CadOptions&) {
  throw InputError(model.file.string() + ": built without OpenCASCADE: cannot read STEP or BREP");
}

SurfaceModel read_cad(const std::filesystem::path& path, const CadOptions&) {
  throw InputError(path.string() + ": built without OpenCASCADE: cannot read STEP or BREP");
}

std::filesystem::path cad_program() { return {}; }

void write_example(const std::string& name, CadFormat, std::ostream&) {
  check_example(name);
  throw InputError("built without OpenCASCADE: cannot make the example '" + name + "'");
}

void write_suite_model(const std::string& name, std::ostream&) {
  throw InputError("built without OpenCASCADE: cannot make the model '" + name + "'");
}

SurfaceModel read_example(const std::string& name, const CadOptions&) {
  check_example(name);
  throw InputError("built without OpenCASCADE: cannot make the example '" + name + "'");
}

}  // namespace delquad
