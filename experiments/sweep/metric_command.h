// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "delquad/metrics.h"
#include "io/cases/case.h"

// This header has measures that other programs take. The bench uses it.

namespace delquad {

/// A measure by another program of each mesh of an experiment.
struct MetricCommand {
  Metric metric = {"", "", "", Better::kNeither, std::numeric_limits<double>::quiet_NaN(), ""};
  /// Program and arguments with placeholders: {mesh}, {folder}, {case}, {pipeline}, {size} and {seed}. Words
  /// that name files beside the experiment stand for them in any working folder, as does a program with a
  /// slash.
  std::vector<std::string> command;
  std::vector<std::string> files = {};  ///< files beside the experiment that determine the value, too
  int timeout = 0;                      ///< seconds; 0: only the limit of the cell
  std::filesystem::path folder = {};    ///< of the experiment
};

/// Returns all placeholders of commands of measures.
const std::vector<std::string>& metric_placeholders();

/// The output of the command for one mesh.
struct MetricOutcome {
  /// Values by key: the key of the metric, or "metric.name" for several values. NaN: not defined.
  std::map<std::string, double> values = {};
  std::string failure = {};  ///< why there are no values; empty: there are
};

/// Runs the command in `folder`, which holds mesh.msh, and returns its values or its failure. The folder gets
/// stdout and stderr as metric-NAME.out and metric-NAME.err.
MetricOutcome run_metric(const MetricCommand& metric, const Case& c, const std::string& pipeline,
                         const std::filesystem::path& folder);

/// Returns the values in a text: a number, or a JSON object of numbers, as the whole or as its last line.
/// Null and NaN are not defined.
MetricOutcome parse_metric_output(const std::string& key, const std::string& text);

/// Returns the files that determine the value, with their digests. Throws InputError if one of `files` cannot
/// be read.
std::map<std::string, std::string> metric_files(const MetricCommand& metric);

}  // namespace delquad
