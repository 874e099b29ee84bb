#pragma once

#include <filesystem>

#include "metrics/tables/table.h"

namespace delquad {

/// Programs and pipelines on the suite, the best first: all families together, then each.
///
/// `results`: a folder with results of the suite, one folder for each run or submission. A case counts as
/// solved when its mesh is sound and has quads only. The score is the mean over all cases of the mean eta
/// times tau times the share of quads, 0 for a case without a sound mesh; in percent. The other measures are
/// means over the sound meshes, but for the worst eta, which is the least, and the CPU seconds, which are the
/// sum. Programs of which all cells are not applicable are not ranked: they have one row, and a note with the
/// reason. Throws InputError where there are no results, or results of something else.
Table rank_programs(const std::filesystem::path& results);

/// Writes the table in every format to results/ranking/table.*.
void write_ranking(const std::filesystem::path& results, const Table& table);

}  // namespace delquad
