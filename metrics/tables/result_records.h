#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "delquad/metrics.h"
#include "metrics/tables/table.h"

namespace delquad {

/// Within this part of a number of quads, two meshes count as equally fine.
inline constexpr double kEquallyMany = 0.01;
/// The layout of records, their entry "record".
inline constexpr int kRecordVersion = 3;
/// Throws InputError for another layout.
void check_record_version(int version);
/// What records call the changing of a size until a number of quads is reached.
inline constexpr const char* kCalibrationStep = "calibration";

/// What came of changing a peer's size until it has as many quads as one of our words.
struct CalibrationRecord {
  std::string to;                ///< the word
  double size_factor = 1;        ///< by which the size was multiplied
  double wanted = 0, quads = 0;  ///< numbers, the word's and its own; 0: the word has no mesh
  long long runs = 1;
  std::string ended_by = {};  ///< failure of a further run; empty: none
};

/// What a record says of one cell of an experiment.
struct CellRecord {
  std::string group, pipeline;           ///< the case with its variant, and the pipeline run on it
  std::string reason;                    ///< why there are no values; empty: there are
  std::map<std::string, double> values;  ///< by metric key, "seconds" and those of steps; NaN: not defined
  std::string name = {};                 ///< of the case alone
  /// The domain that the case counts as, see domains_of(); empty: the case is a domain of its own.
  std::string domain = {};
  std::string model = {};  ///< digest of what the case is made from
  bool is_peer = false;    ///< another mesher, and no word
  long long seed = 0;
  std::vector<std::pair<std::string, std::string>> variant = {};
  std::string kind = {};  ///< of the reason: as in failure_record(), or "damaged": the record cannot be read
  bool skipped = false;   ///< for that reason, and not failed
  bool quads_only = false;  ///< triangles that are left are an error
  std::vector<std::string> warnings = {};
  std::vector<std::string> unsound = {};          ///< why its mesh is not sound; empty: it is
  std::string uniform_size = {};                  ///< delta, where it was asked to be the same everywhere
  std::vector<std::string> size_adapted_to = {};  ///< what made the size less than was asked for
  std::vector<Metric> own_metrics = {};           ///< that the project itself does not have
  std::map<std::string, std::string> failed_metrics = {};  ///< why a measure has no value, by key
  bool metric_failed = false;  ///< one of them by a command, which may come out otherwise
  std::optional<CalibrationRecord> calibration = {};  ///< of a peer
  std::filesystem::path folder = {};                  ///< of the cell
};

/// The files record.json below a folder, by path; those of unfinished cells are left out. Throws InputError
/// when it cannot be read.
std::vector<std::filesystem::path> record_files(const std::filesystem::path& folder);

/// The measures of records that the project itself does not have, each once, in the order of records: with a
/// measure for each of the values that a command gave, "name.part".
std::vector<Metric> own_metrics_of(const std::vector<CellRecord>& records);
/// Columns beside measures: what records say, and times. Tables have those that an experiment asks for.
const std::vector<Metric>& columns_of_records();

/// The records of an experiment below a folder, in the order of its study.json, if there is one, and by path.
/// What is no record, or was changed since its digest was taken, is a cell that failed, "damaged record: "
/// with file and reason. Throws InputError naming the cell that is there twice, or the folder that has none.
std::vector<CellRecord> read_records(const std::filesystem::path& folder);

/// What there is of the cell with this key in its folder: "done", "metric failed", "failed", "skipped" or
/// kNotApplicable by its record; "to do": there is none; "damaged": the record was changed or cut off, or its
/// mesh has not as many bytes as it says; "outdated": of another key. Costs little: meshes are not read.
std::string state_of_cell(const std::filesystem::path& folder, const std::string& key);
/// What the record counts as among domains.
const std::string& domain_of(const CellRecord& record);
/// By its state, whether a cell has its mesh: measures by command may have failed.
bool has_mesh(const std::string& state);

}  // namespace delquad
