#pragma once

#include <filesystem>
#include <string>

#include "experiments/console/progress.h"
#include "experiments/sweep/experiment.h"
#include "metrics/tables/table.h"

namespace delquad {

int linf_study_steps(const LinfStudy& study);

/// Compares the L-infinity and the L2 Delaunay triangulation on evenly spread points (a jittered grid) and on
/// random ones. Draws folder/<points>-<distribution>-<seed>.svg.
Table run_linf_study(const LinfStudy& study, const std::string& title, const std::filesystem::path& folder,
                     Progress& progress);

}  // namespace delquad
