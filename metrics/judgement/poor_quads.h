#pragma once

#include <string>
#include <vector>

#include "delquad/options.h"
#include "geometry/mesh/quad_corners.h"
#include "patches/prepared.h"

namespace delquad {

/// A quad is poor with an angle below 10 or above 170 degrees (eta below kBadEta), with longer sides than
/// this times the shortest, or with a side below this part of the size there.
inline constexpr double kPoorAspect = 20, kPoorEdge = kShortSide;

/// What no element may be beyond.
struct LimitOptions {
  double min_angle = 0;   ///< degrees
  double max_aspect = 0;  ///< of longest over shortest side; 0: any
};
OptionGroup limit_group();

/// Quads with an eta below kBadEta: in corners of the model that forbid more, and others.
struct BadQuads {
  int in_corners = 0, elsewhere = 0;
};

/// Counts the bad quads of a mesh. Warns in one line of those that are poor, with the worst of them, why
/// that is as far as it is known, and what helps; and of quads that single precision cannot hold. Says which
/// elements are beyond the limits that were asked for, see Soundness::beyond, and what of the model stands in
/// the way of ones that are inverted or flat. Aspects and sides of layers, and of grids that were asked for,
/// are as they are on purpose; of quads by a metric only what was asked for and single precision count.
/// `label` names the case and pipeline.
BadQuads judge_quads(const PreparedProblem& prepared, const std::string& label, const Mesh& mesh,
                     const MeshMetrics& metrics, std::vector<Warning>& warnings, Soundness& soundness);

/// Judges the result's mesh by the problem's criteria, where it has some: its report, measures of tables and,
/// where that is strict, what is beyond. `is_others`: another program made the mesh, from the same model.
void judge_by_criteria(const PreparedProblem& prepared, bool is_others, MeshResult& result);

/// The part of the quads that is beyond the problem's criteria; 0 if it has none.
double failing_part(const PreparedProblem& prepared, const Mesh& mesh);

}  // namespace delquad
