#pragma once

#include <vector>

#include "delquad/mesh.h"
#include "delquad/metrics.h"

namespace delquad {

/// See SurfaceReport::near_cuts. `is_cut`: of each curve of the mesh, whether it is no curve of the model.
void measure_near_cuts(const Mesh& mesh, const std::vector<char>& is_cut, QuadShare& near, QuadShare& off);

}  // namespace delquad
