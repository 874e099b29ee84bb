#pragma once

#include <string>

#include "pipeline/runner.h"

namespace delquad {

/// The JSON record of a pipeline on a case: every option, what the stages did, times, metrics, versions.
/// Ends with a newline.
std::string run_record(const Case& c, const PreparedCase& prepared, const Word& word,
                       const RunResult& result);
/// The record of one that was not run, "failed" or "skipped" by its status.
std::string failure_record(const Case& c, const Word& word, const std::string& status,
                           const std::string& reason);
/// The metrics of a mesh from a file.
std::string metrics_record(const std::string& mesh_file, const std::string& size, const MeshMetrics& metrics);

}  // namespace delquad
