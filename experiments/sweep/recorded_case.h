#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "experiments/sweep/experiment.h"

namespace delquad {

/// The folder of the results that a cell's record belongs to.
std::filesystem::path results_of(const std::filesystem::path& record_file);

/// The experiment that a record was made from, by its copy in the folder `results`. Throws InputError when it
/// was changed or is not there.
Experiment recorded_experiment(const nlohmann::ordered_json& record, const std::filesystem::path& results,
                               const std::filesystem::path& data);

/// The variant of a case that a record is of. A model that is a file is that with the digest of the record:
/// at its place, or anywhere below `data` by its name. Throws InputError, naming file and digest, when there
/// is none, and when the experiment has no such variant.
Case recorded_case(const nlohmann::ordered_json& record, const Experiment& experiment,
                   const std::filesystem::path& data);

}  // namespace delquad
