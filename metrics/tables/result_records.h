// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "delquad/metrics.h"
#include "metrics/tables/table.h"

// This header has the records of an experiment's cells. Tables, the bench and reports use it.

namespace delquad {

/// Relative difference up to which numbers of quads count as equal.
inline constexpr double kEquallyMany = 0.01;
/// Version of the layout of records, in their entry "record".
inline constexpr int kRecordVersion = 3;
/// Throws InputError for another version.
void check_record_version(int version);
/// Name in records of the step that changes a size to reach a number of quads.
inline constexpr const char* kCalibrationStep = "calibration";

/// Result of changing a peer's size to reach the number of quads of a pipeline.
struct CalibrationRecord {
  std::string to;                ///< the pipeline
  double size_factor = 1;        ///< factor of the size
  double wanted = 0, quads = 0;  ///< numbers of the pipeline and of the peer; 0: the pipeline has no mesh
  long long runs = 1;
  std::string ended_by = {};  ///< failure of a later run; empty: none
};

/// Content of the record of a cell.
struct CellRecord {
  std::string group, pipeline;           ///< the case with its variant, and its pipeline
  std::string reason;                    ///< reason for missing values; empty: none is missing
  std::map<std::string, double> values;  ///< by metric key, "seconds" and times of steps; NaN: not defined
  std::string name = {};                 ///< name of the case
  /// Domain that the case counts as, see domains_of(); empty: a domain of its own.
  std::string domain = {};
  std::string model = {};  ///< digest of the case's model
  bool is_peer = false;    ///< another mesher, not a pipeline
  long long seed = 0;
  std::vector<std::pair<std::string, std::string>> variant = {};
  std::string kind = {};    ///< kind of the reason as in failure_record(), or "damaged": the record is
                            ///< unreadable
  bool skipped = false;     ///< skipped for that reason, not failed
  bool quads_only = false;  ///< leftover triangles are an error
  std::vector<std::string> warnings = {};
  std::vector<std::string> unsound = {};                   ///< why its mesh is unsound; empty: it is sound
  std::string uniform_size = {};                           ///< delta, if it was requested to be uniform
  std::vector<std::string> size_adapted_to = {};           ///< reasons for a size below the requested one
  std::vector<Metric> added_metrics = {};                  ///< measures that are not built in
  std::map<std::string, std::string> failed_metrics = {};  ///< reasons for missing measures, by key
  bool metric_failed = false;  ///< a measure by a command failed, which may succeed another time
  std::optional<CalibrationRecord> calibration = {};  ///< of a peer
  std::filesystem::path folder = {};                  ///< folder of the cell
};

/// Returns the files record.json below a folder, by path, without unfinished cells. Throws InputError if the
/// folder is unreadable.
std::vector<std::filesystem::path> record_files(const std::filesystem::path& folder);

/// Returns the measures of records that are not built in, each once, in the order of records. Each value of a
/// command is one, "name.part".
std::vector<Metric> added_metrics_of(const std::vector<CellRecord>& records);
/// Returns columns beside measures: entries of records, and times. Tables have those that an experiment
/// requests.
const std::vector<Metric>& columns_of_records();

/// Reads the records of an experiment below a folder, in the order of its study.json, if any, and by path. A
/// file that is no record, or differs from its digest, is a failed cell, "damaged record: " with file and
/// reason. Throws InputError for a cell that exists twice, and for a folder without records.
std::vector<CellRecord> read_records(const std::filesystem::path& folder);

/// Returns the state of the cell with this key in its folder. By its record it is "done", "metric failed",
/// "failed", "skipped" or kNotApplicable. Without a record it is "to do"; with another key it is "outdated".
/// A record or size of mesh that was changed is "damaged". It is fast, since meshes are not read.
std::string state_of_cell(const std::filesystem::path& folder, const std::string& key);
/// Returns the record's domain.
const std::string& domain_of(const CellRecord& record);
/// Returns whether a cell in this state has its mesh; measures by command may have failed.
bool has_mesh(const std::string& state);

}  // namespace delquad
