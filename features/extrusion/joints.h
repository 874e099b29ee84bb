// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "delquad/mesh.h"
#include "features/extrusion/layers.h"
#include "features/extrusion/section.h"

// This header thickens joints, where three or more quads share an edge. Sweeps use it.

namespace delquad {

/// Finds the joints of a section and gives each part of the surface at a joint its own copies of the points.
/// Lines on joints go, which a note tells. Throws InputError, with the place, if joints meet in a point, or
/// end inside of a part.
void split_joints(Section& section, ReadNotes* notes);

/// Moves the points of `layered` at joints to the places where the walls of neighboring parts meet, and adds
/// points and hexahedra in between. Seen along the joint they make a polygon with a corner between each two
/// parts, divided from its center into quads. Throws InputError, with the place, for an odd number of layers
/// (own method).
void fill_joints(const Section& section, LayeredPoints& layered);

}  // namespace delquad
