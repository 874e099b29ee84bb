// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "delquad/options.h"
#include "geometry/mesh/quad_corners.h"
#include "geometry/patches/meshing_setup.h"

// This header judges the quads of finished meshes. The pipeline uses it.

namespace delquad {

/// A quad is poor if its eta is below kBadEta (an angle below 10 or above 170 degrees). It is also poor with
/// a larger aspect than this, or with a side below this part of the size there.
inline constexpr double kPoorAspect = 20, kPoorEdge = kShortSide;

/// Limits for every element.
struct LimitOptions {
  double min_angle = 0;   ///< degrees, 0 to 90; 0: no limit
  double max_aspect = 0;  ///< longest over shortest side; 0: no limit
};
OptionGroup limit_group();

/// Quads with an eta below kBadEta: in corners of the model that forbid more, and elsewhere.
struct BadQuads {
  int in_corners = 0, elsewhere = 0;
};

/// Returns the number of bad quads of a mesh. One warning tells the number of poor quads, the worst of them,
/// causes and remedies. Another one tells quads that single precision cannot hold. `soundness` gets elements
/// beyond requested limits (Soundness::beyond), and causes of inverted or flat elements. Sides and aspects in
/// layers and requested grids do not count. In meshes by a metric, only requested limits and single precision
/// count. `label` names case and pipeline.
BadQuads judge_quads(const MeshingSetup& prepared, const std::string& label, const Mesh& mesh,
                     const MeshMetrics& metrics, std::vector<Warning>& warnings, Soundness& soundness);

/// Judges the result's mesh by the criteria of the problem, if any: report, measures for tables, and elements
/// beyond strict criteria. `is_others` tells that another program made the mesh, from the same model.
void judge_by_criteria(const MeshingSetup& prepared, bool is_others, MeshResult& result);

/// Returns the share of quads, 0 to 1, beyond the problem's criteria; 0 without criteria.
double failing_part(const MeshingSetup& prepared, const Mesh& mesh);

}  // namespace delquad
