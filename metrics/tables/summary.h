#pragma once

#include <vector>

#include "metrics/tables/inference.h"
#include "metrics/tables/result_records.h"
#include "metrics/tables/study_file.h"
#include "metrics/tables/table.h"

namespace delquad {

/// Pipelines beside each other, over all domains: a row for each in each measure that pairs are compared by.
/// A study of one pipeline has rows for the values of the axes that it compares.
///
/// A row has the mean of the domains' means with the interval of interval_of_mean(). It counts the domains
/// that it failed on, won and lost. It wins a domain if it is better there than every other row that it has a
/// pair with. It loses the domain if it is worse than every one. Last it names the rows than which it is
/// proven to be better. There are no rows for fewer than two domains.
Table summarise(const StudyFile& study, const std::vector<CellRecord>& records, const Inference& inference);

}  // namespace delquad
