// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "delquad/mesh.h"

// This header orients faces alike. Readers of CAD use it.

namespace delquad::cad {

struct Agreement {
  int n_turned = 0;        ///< number of reversed faces
  bool orientable = true;  ///< false: no choice makes all neighbors agree
};

/// Reverses the fewest faces so that neighbors (across edges of exactly two triangles) agree.
Agreement agree_faces(Mesh& mesh);

/// Reverses each group of faces (indices of regions) that is closed and encloses a negative volume. Returns
/// the number of groups.
int turn_outwards(Mesh& mesh, const std::vector<std::vector<int>>& groups);

}  // namespace delquad::cad
