// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/warning.h"
#include "delquad/fields.h"
#include "delquad/mesh.h"
#include "features/sizes/fine_spots.h"

// This header makes sizes in narrow gaps. The composition of sizes uses it.

namespace delquad {

/// Looks at a patch. `points`: of the nodes in space. `cut_face`: as in SurfaceDomain, whose cuts are no
/// curves; empty in the plane.
using LookAtPatch = std::function<void(const PatchBoundary& patch, const std::vector<Vec3>& points,
                                       const std::vector<int>& cut_face)>;
/// Meshes all curves by a size, and looks at the patches.
using CurvesBySize =
    std::function<void(const std::shared_ptr<const SizeField>& size, const LookAtPatch& look)>;

/// Returns the edges of curves that face others across a patch nearer than `rows` times the size. Beside
/// each, the size fits a gap which holds so many rows, though it is no less than a twentieth of `size`. Near
/// a corner between the curves there is no gap. Curves are meshed by smaller sizes until gaps hold their
/// rows, at most four times.
std::vector<LocalSize> sizes_in_gaps(const std::shared_ptr<const SizeField>& size, int rows,
                                     const CurvesBySize& curves_by);

/// Warns if rows in gaps make many more quads than before.
void warn_of_many_rows(const std::string& name, int rows, double before, double after,
                       std::vector<Warning>& warnings);

}  // namespace delquad
