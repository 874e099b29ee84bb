#pragma once

#include "delquad/mesh.h"

namespace delquad {

/// eta of a quad with a sign [paper, equation (4), extended]: 1 - max |90 deg - angle| / 90 deg over the four
/// interior angles, taken in [0, 360) degrees. 1 for a rectangle, 0 with an angle of 0 or 180, below 0 (down
/// to -2) the further an angle is reflex, so that bad quads can be told from worse ones.
double signed_eta(Vec2 a, Vec2 b, Vec2 c, Vec2 d);

}  // namespace delquad
