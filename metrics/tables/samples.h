#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "metrics/tables/result_records.h"
#include "metrics/tables/statistics.h"

namespace delquad {

/// The axis whose values are samples of the same thing.
inline constexpr const char* kSeedAxis = "seed";

/// The value of a measure; NaN: not known.
double value_of(const CellRecord& record, const std::string& key);
/// The mesh has quads.
bool makes_quads(const CellRecord& record);
/// The mesh has triangles beside its quads.
bool leaves_triangles(const CellRecord& record);
/// The measure is of quads alone, or of vertices among quads: triangles that are left make it look better.
bool is_of_quads(const std::string& key);
/// The case and what else tells the runs of a row from those of others: its variant without the seed, and
/// without `along`.
std::string row_group(const CellRecord& record, const std::string& along = "");
/// The value of an axis, by its title; that of none is the pipeline.
const std::string& value_along(const CellRecord& record, const std::string& along);

/// The cells of one row: a pipeline on a variant, with every seed.
struct Samples {
  std::string group, pipeline;
  std::vector<const CellRecord*> done, skipped, failed;

  /// Of a measure, those that are known.
  std::vector<double> of(const std::string& key) const;
};

/// By group, in the order of the first cell of each. The records have to outlive it.
std::vector<Samples> group_samples(const std::vector<CellRecord>& records);

/// Two sides on every domain where they ran the same case, variant and seed. Two values along an axis ran
/// them with the same pipeline, and share the variant but for that axis. A domain's difference is the mean
/// over its variants of the mean over their seeds.
///
/// A side fails on a domain if it has no value in a run in which the other side has one. It loses there: the
/// difference is infinite. Where both fail, the domain is left out.
struct PairedDomains {
  std::vector<std::string> names;
  std::vector<double> differences;             ///< by domain, first minus second
  std::array<std::size_t, 2> failed = {0, 0};  ///< on how many of the domains each side has
  std::vector<std::string> left_out;
  std::size_t runs = 0;  ///< pairs of them, both with a value

  /// The differences of domains on which neither has failed.
  std::vector<double> finite() const;
  bool has_failures() const { return failed[0] + failed[1] > 0; }
};
/// Takes records that were not skipped. `of_quads`: a mesh without quads counts as none.
PairedDomains pair_by_domain(std::span<const CellRecord* const> a, std::span<const CellRecord* const> b,
                             const Metric& metric, const std::string& along = "", bool of_quads = true);
/// The mean of each domain on which there are values.
std::vector<double> means_by_domain(std::span<const CellRecord* const> runs, const std::string& key);

}  // namespace delquad
