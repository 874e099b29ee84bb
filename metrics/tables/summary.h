// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "metrics/tables/inference.h"
#include "metrics/tables/result_records.h"
#include "metrics/tables/study_file.h"
#include "metrics/tables/table.h"

// This header compares pipelines over all domains. The tables use it.

namespace delquad {

/// Returns the comparison of pipelines over all domains: a row for each, in each measure in which pairs are
/// compared. A study of one pipeline has rows for the values of its compared axes.
Table summarise(const StudyFile& study, const std::vector<CellRecord>& records, const Inference& inference);

}  // namespace delquad
