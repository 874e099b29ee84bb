#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "metrics/tables/result_records.h"
#include "metrics/tables/statistics.h"
#include "metrics/tables/table.h"

namespace delquad {

/// Which measures are to be set against which others: [correlate] of an experiment.
struct CorrelationRequest {
  std::vector<std::string> of;    ///< keys of what matters: "poisson_h1"
  std::vector<std::string> with;  ///< keys of what is easily measured: "eta_mean"
};

/// Ranks from 1, ties share their mean.
std::vector<double> ranks(std::span<const double> values);
/// Spearman's coefficient [spearman1904]: that of Pearson between ranks. Nothing of fewer than three pairs,
/// and where either side has the same value everywhere.
std::optional<double> spearman(std::span<const double> a, std::span<const double> b);

/// A correlation within domains.
struct Correlation {
  std::string of, with;
  std::vector<double> by_domain;          ///< of each domain where it is defined
  std::size_t domains = 0;                ///< with and without
  std::size_t runs = 0;                   ///< in those where it is defined
  double mean = 0;                        ///< over domains; NaN of none
  std::optional<Interval> interval = {};  ///< 95 %, by interval_of_mean(); of six or more
};

/// Spearman's coefficients over the runs (words and seeds) of each variant of each domain, meaned over
/// the variants of a domain. Measures of solvers are multiplied by the power of the number of vertices that
/// makes them independent of it under refinement, see power_of_vertices(): pipelines that make more elements
/// get no credit for it. The records have to be of meshes; others are left out.
std::vector<Correlation> correlate(const CorrelationRequest& request, const std::vector<CellRecord>& records);

/// No rows where nothing was asked for.
Table correlation_table(const std::string& title, const std::vector<Correlation>& correlations);

}  // namespace delquad
