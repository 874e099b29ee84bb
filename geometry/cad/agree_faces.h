// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "delquad/mesh.h"

// This header orients faces alike. Readers of CAD use it.

namespace delquad::cad {

struct Agreement {
  int n_turned = 0;        ///< faces turned over
  bool orientable = true;  ///< false: no choice makes all neighbors agree
};

/// Turns as few faces over as it takes for neighbors (across edges of exactly two triangles) to agree.
Agreement agree_faces(Mesh& mesh);

/// Turns each group of faces (indices of regions) over that is closed and encloses a negative volume; returns
/// how many.
int turn_outwards(Mesh& mesh, const std::vector<std::vector<int>>& groups);

}  // namespace delquad::cad
