#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "experiments/sweep/run_experiment.h"

namespace delquad {

/// Runs all pipelines of every variant of every case again, experiment.repeat_times times, one process at a
/// time, in an order that changes from round to round: what else the machine does meets them all alike.
/// Writes DIR/<case>/times.json (see times.h), whole or not at all. Variants are left out whose times are
/// there already, of the same cells; so are cells that have not been made. Of a cell that fails, the file
/// says why.
void repeat_times(const Experiment& experiment, const std::filesystem::path& folder,
                  const SweepOptions& options);

/// The order of `n` pipelines in a round on a variant: a random permutation, the same every time.
std::vector<std::size_t> order_of_round(std::size_t n, std::size_t variant, std::size_t round);

}  // namespace delquad
