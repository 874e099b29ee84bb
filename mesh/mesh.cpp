#include "delquad/mesh.h"

#include "base/box.h"

namespace delquad {

double diagonal(const Mesh& mesh) { return diagonal(mesh.points); }

}  // namespace delquad
