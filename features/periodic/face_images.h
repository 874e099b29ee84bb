#pragma once

#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// Gives the faces of `mesh.periodic_faces` the elements of their masters, moved, which must be there, and
/// adds the nodes inside to the pairs. Faces that are `left_out` (by region) lose their pair.
void add_face_images(const std::vector<char>& left_out, Mesh& mesh);

}  // namespace delquad
