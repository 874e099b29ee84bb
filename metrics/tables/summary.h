#pragma once

#include <string>
#include <utility>
#include <vector>

#include "metrics/tables/inference.h"
#include "metrics/tables/result_records.h"
#include "metrics/tables/study_file.h"
#include "metrics/tables/table.h"

namespace delquad {

/// Words beside each other, over all domains. Of each in each measure that pairs are compared by: the mean of
/// its domains' means with the 95 % interval of interval_of_mean(); on how many domains it is better than
/// every other word that it has a pair with there, and on how many worse than every one; and than which words
/// it is proven to be better.
struct Summary {
  Table by_word;     ///< a row for each word, with all measures
  Table by_measure;  ///< the same as it is printed: a group for each measure, a row for each word
};
/// No rows where there are fewer than two domains.
Summary summarise(const StudyFile& study, const std::vector<CellRecord>& records, const Inference& inference);

}  // namespace delquad
