// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "delquad/error.h"
#include "delquad/model.h"
#include "geometry/mesh/entity_names.h"

// This header removes small parts of planar models. The preparation uses it.

namespace delquad {

struct SmallOutlines {
  double length = 0;    ///< of curves and between corners; 0: all stay
  double hole = 0;      ///< length of the outline of a hole; 0: all stay
  KeptNames keep = {};  ///< holes stay that have such names, of curves or of a region
};

/// Returns the model without what is smaller:
/// - holes and inclusions whose outline is shorter than `hole`, with what lies in them;
/// - nodes: where corners and ends of curves follow each other within `length`, the ones that turn less are
///   none any more. Curves become one there, if they have one name and no others meet them. The outline
///   itself stays, so that nodes lie on it. Curves keep their numbers, and curves that became part of another
///   are gone. Warnings name each with its place, and the short curves that stay.
PlanarModel leave_out_small(PlanarModel model, const SmallOutlines& small, std::vector<Warning>& warnings);

}  // namespace delquad
