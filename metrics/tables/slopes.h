#pragma once

#include <string>
#include <vector>

#include "metrics/tables/result_records.h"
#include "metrics/tables/table.h"

namespace delquad {

/// By which power measures go with another, as an axis of the experiment varies: [slopes].
struct SlopeRequest {
  std::vector<std::string> of;         ///< keys of measures: "poisson_h1"
  std::string along;                   ///< title of the axis: "quads"
  std::string against = "n_vertices";  ///< key of a measure, or "seconds"
};

/// A row for each pipeline and option on each case: the power by least squares of the logarithms over all
/// runs along the axis, with half of its 95 % interval by Student's t; the measure that this law has where
/// `against` is the geometric mean of all runs of the case, so that rows compare; and at how many steps along
/// the axis the mean over seeds does not fall. Then the mean power over the cases. Records without the axis
/// are left out, and so are values that are not above 0.
Table slope_table(const std::string& title, const SlopeRequest& request,
                  const std::vector<CellRecord>& records);

}  // namespace delquad
