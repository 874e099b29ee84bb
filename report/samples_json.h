#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "metrics/tables/result_records.h"
#include "metrics/tables/table.h"

namespace delquad {

using Json = nlohmann::ordered_json;

/// Empty where there is none.
std::string seed_of(const CellRecord& record);

/// For each pipeline of a sheet with several seeds: how many of its cells are done, and means with half the
/// width of their 95 % confidence intervals, by column key. Empty where no pipeline has two.
Json means_json(std::span<const CellRecord* const> cells, const std::vector<TableColumn>& columns);

/// What the cells that are done have in each column, for charts of their spread: `sheets` with
/// their `cases`, `words` and `keys`, and `cells`, each with the places of its sheet and word, then a value
/// or null for each key.
Json samples_json(const std::vector<CellRecord>& records, const std::vector<TableColumn>& columns);

/// With five digits, more than a chart shows; null of NaN.
Json brief_number(double value);

}  // namespace delquad
