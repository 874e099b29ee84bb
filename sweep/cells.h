#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "sweep/experiment.h"
#include "sweep/record.h"

namespace delquad {

/// Digest of what a case is made from: the bytes of its file, or its curves, loops and names.
std::string model_digest(const Case& c);

/// The cell of a pipeline on a variant of a case. `place`: as in CellIdentity.
CellIdentity identify(const Experiment& experiment, const Case& c, const std::string& model_digest,
                      const std::array<std::size_t, 3>& place);

/// Where the results of a cell lie, below the folder of the experiment.
std::filesystem::path cell_folder(const std::filesystem::path& folder, const Case& c, const Word& word);

/// What the record in a cell's folder says at its beginning.
struct RecordHead {
  std::string key, status;
  std::string metrics_status = {};  ///< "failed" where a measure has no value
};
/// Nothing where there is no record, or one that was not written by an experiment. Costs little.
std::optional<RecordHead> read_head(const std::filesystem::path& cell);

}  // namespace delquad
