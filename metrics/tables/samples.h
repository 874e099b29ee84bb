// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "metrics/tables/result_records.h"
#include "metrics/tables/statistics.h"

// This header groups records by rows and domains. Tables and reports use it.

namespace delquad {

/// Axis whose values are samples of the same thing.
inline constexpr const char* kSeedAxis = "seed";

/// Returns the value of a measure; NaN: not known.
double value_of(const CellRecord& record, const std::string& key);
/// Returns whether the mesh has quads.
bool makes_quads(const CellRecord& record);
/// Returns whether the mesh has triangles beside quads.
bool leaves_triangles(const CellRecord& record);
/// Returns whether the measure is only of quads, or of vertices among quads: leftover triangles improve it.
bool is_of_quads(const std::string& key);
/// Returns the row of a run: its case and its variant, without the seed and without `along`.
std::string row_group(const CellRecord& record, const std::string& along = "");
/// Returns the value on an axis, by title; for an empty title the pipeline.
const std::string& value_along(const CellRecord& record, const std::string& along);

/// Cells of a row: a pipeline on a variant, with all seeds.
struct Samples {
  std::string group, pipeline;
  std::vector<const CellRecord*> done, skipped, failed;

  /// Returns the known values of a measure.
  std::vector<double> of(const std::string& key) const;
};

/// Groups records in the order of the first cell of each. The records must outlive the result.
std::vector<Samples> group_samples(const std::vector<CellRecord>& records);

/// Comparison of two sides on every domain where both ran the same case, variant and seed. Two values on an
/// axis need the same pipeline and the same variant but for that axis. The difference on a domain is the mean
/// over variants of the mean over seeds.
///
/// A side fails on a domain if it lacks a value in a run where the other side has one. It loses there: the
/// difference is infinite. Domains on which both fail are left out.
struct PairedDomains {
  std::vector<std::string> names;
  std::vector<double> differences;             ///< by domain, first minus second
  std::array<std::size_t, 2> failed = {0, 0};  ///< number of domains on which each side failed
  std::vector<std::string> left_out;
  std::size_t runs = 0;  ///< pairs with both values

  /// Returns the differences on domains where neither failed.
  std::vector<double> finite() const;
  bool has_failures() const { return failed[0] + failed[1] > 0; }
};
/// Returns the pairs of records that were not skipped. With `of_quads`, a mesh without quads counts as none.
PairedDomains pair_by_domain(std::span<const CellRecord* const> a, std::span<const CellRecord* const> b,
                             const Metric& metric, const std::string& along = "", bool of_quads = true);
/// Returns the mean of each domain that has values.
std::vector<double> means_by_domain(std::span<const CellRecord* const> runs, const std::string& key);

}  // namespace delquad
