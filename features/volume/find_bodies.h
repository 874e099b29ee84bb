// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "delquad/mesh.h"

// This header finds the bodies that quads enclose. Volume meshes use it.

namespace delquad {

/// A side of a quad in the boundary of a body.
struct BodySide {
  int quad;
  bool is_reversed;  ///< seen from outside of the body, the quad runs clockwise
};
using Body = std::vector<BodySide>;

/// Returns the bodies: spaces enclosed by quads, with shells of cavities. A space inside another body is a
/// cavity if the normals of its quads point into it, which `notes` tells. Throws InputError with the place of
/// an open edge.
std::vector<Body> find_bodies(const Mesh& skin, ReadNotes* notes);

}  // namespace delquad
