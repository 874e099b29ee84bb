#pragma once

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
  /// Of repeated runs, all seeds together.
  std::vector<double> times(const std::string& key) const;
};

/// By group, in the order of the first cell of each. The records have to outlive it.
std::vector<Samples> group_samples(const std::vector<CellRecord>& records);

/// What a value is tested by: that of the record, or the median of repeated runs where there are any.
enum class ValueKind { kMeasure, kRepeatedTime };

/// a - b on every domain where both have a value for the same case, variant and seed; of two values along an
/// axis also the same pipeline, and the variant without that axis.
struct PairedDomains {
  std::vector<std::string> names;
  std::vector<DomainSamples> differences;
  std::size_t runs = 0;  ///< pairs of them

  std::vector<double> means() const;  ///< of each domain
};
PairedDomains pair_by_domain(std::span<const CellRecord* const> a, std::span<const CellRecord* const> b,
                             const std::string& key, ValueKind kind = ValueKind::kMeasure,
                             const std::string& along = "");
/// The mean of each domain on which there are values.
std::vector<double> means_by_domain(std::span<const CellRecord* const> runs, const std::string& key,
                                    ValueKind kind = ValueKind::kMeasure);

/// a - b of the runs of the same variant and seed, whatever their domain.
std::vector<double> pair_by_run(std::span<const CellRecord* const> a, std::span<const CellRecord* const> b,
                                const std::string& key);

}  // namespace delquad
