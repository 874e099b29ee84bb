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

/// A measure that another program takes of each mesh of an experiment.
struct MetricCommand {
  Metric metric = {"", "", "", Better::kNeither, std::numeric_limits<double>::quiet_NaN(), ""};
  /// Program and arguments; {mesh}, {folder}, {case}, {pipeline}, {size} and {seed} stand for these. Words
  /// that name files beside the experiment stand for them, wherever it is run; so does the program if it has
  /// a slash.
  std::vector<std::string> command;
  std::vector<std::string> files = {};  ///< beside the experiment, which determine the value, too
  int timeout = 0;                      ///< seconds; 0: no limit but the cell's
  std::filesystem::path folder = {};    ///< of the experiment
};

/// Returns the placeholders in the arguments of a metric's command.
const std::vector<std::string>& metric_placeholders();

/// The output of the command for one mesh.
struct MetricOutcome {
  /// By key: the key of the metric, or "metric.name" if the metric gave several. NaN: it is not defined.
  std::map<std::string, double> values = {};
  std::string failure = {};  ///< why there are none; empty: there are
};

/// Runs the command in `folder`, which holds mesh.msh, and gets what it printed on stdout and stderr, as
/// metric-NAME.out and metric-NAME.err.
MetricOutcome run_metric(const MetricCommand& metric, const Case& c, const std::string& pipeline,
                         const std::filesystem::path& folder);

/// Returns the values in a text: a number, or a JSON object of numbers, as the whole or as its last line. A
/// value that is null or NaN is not defined.
MetricOutcome parse_metric_output(const std::string& key, const std::string& text);

/// Returns the files that determine the value, with their digests. Throws InputError for one of `files` that
/// cannot be read.
std::map<std::string, std::string> metric_files(const MetricCommand& metric);

}  // namespace delquad
