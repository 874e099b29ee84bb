#pragma once

#include <string>

#include "delquad/model.h"

namespace delquad {

/// Half a model of triangles, completed with its mirror image, which runs the other way round so that both
/// agree in orientation. Ends of open edges within the tolerance are moved onto the plane and belong to both
/// halves; lines there go. Both images of a line are on its curve. Throws InputError, beginning with
/// `source`, when points lie on both sides of the plane beyond the tolerance, when no open edge lies in the
/// plane and when a triangle does.
Mesh add_mirror_image(Mesh half, const MirrorPlane& plane, const std::string& source);

}  // namespace delquad
