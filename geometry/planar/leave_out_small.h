// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "delquad/error.h"
#include "delquad/model.h"
#include "geometry/mesh/entity_names.h"

// This header removes small parts of planar models. The preparation uses it.

namespace delquad {

struct SmallOutlines {
  double length = 0;    ///< least length of curves and between corners; 0: all stay
  double hole = 0;      ///< least length of the outline of a hole; 0: all stay
  KeptNames keep = {};  ///< names of curves or regions whose holes stay
};

/// Returns the model without smaller details (own method):
/// - holes and inclusions whose outline is shorter than `hole`, with their contents;
/// - nodes: if corners and ends of curves follow each other within `length`, the ones that turn less are
///   removed. Curves are joined there if they have the same names and no others meet them. The shape of the
///   outline stays. Curves keep their numbers, and curves that joined another one are marked as gone.
///   Warnings name each with its place, and the short curves that stay.
PlanarModel leave_out_small(PlanarModel model, const SmallOutlines& small, std::vector<Warning>& warnings);

}  // namespace delquad
