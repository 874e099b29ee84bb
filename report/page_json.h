#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "metrics/tables/result_records.h"
#include "metrics/tables/table.h"

namespace delquad {

using Json = nlohmann::ordered_json;

/// The texts of a table's files by extension, packed: what one saves from the page is what a run writes.
Json table_files_json(const Table& table);
/// As the page shows it, with its files; empty ones are null.
Json table_json(const Table& table);

/// For each pipeline and case: elements and seconds of the case's variants, and the power law that they
/// follow where there are three sizes or more, the largest at least four times the smallest.
Json growth_json(const std::vector<CellRecord>& records);

/// What letters and measures mean, and colours by eta.
Json glossary_json();

}  // namespace delquad
