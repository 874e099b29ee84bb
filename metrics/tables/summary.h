// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "metrics/tables/inference.h"
#include "metrics/tables/result_records.h"
#include "metrics/tables/study_file.h"
#include "metrics/tables/table.h"

// This header compares pipelines over all domains. The tables use it.

namespace delquad {

/// Compares pipelines over all domains: a row for each, in each measure in which pairs are compared. A study
/// of one pipeline has rows for the values of its compared axes.
///
/// A row has the mean of the domains' means with its interval_of_mean(), and counts of failed, won and lost
/// domains. It wins a domain if it is better there than every row that it has a pair with. It loses if it is
/// worse than every one. Last, it names the rows than which it is proven better. Returns no rows for fewer
/// than two domains.
Table summarise(const StudyFile& study, const std::vector<CellRecord>& records, const Inference& inference);

}  // namespace delquad
