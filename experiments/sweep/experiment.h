// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "delquad/extend.h"
#include "experiments/sweep/experiment_fields.h"
#include "io/cases/case.h"
#include "io/cases/toml_reader.h"
#include "metrics/tables/study_file.h"

// This header has experiments as files describe them. The bench and the report use it.

namespace delquad {

/// An option that an experiment varies.
struct Axis {
  std::string key;                  ///< dotted: "insertion.h_max"
  std::string title;                ///< last part of the key, or as much as distinguishes it
  std::vector<std::string> values;  ///< as texts
};

/// A file of experiments/: cases, their pipelines, and published values.
///
/// Each case has as many variants as the [matrix] has combinations (one without a matrix). Variants are read
/// on demand, since there may be many.
class Experiment : public TablePlan, public ExperimentKeys {
 public:
  std::filesystem::path file;
  std::vector<Pipeline> parsed;  ///< pipelines; peers are pipelines without stages
  std::string calibrate_where;   ///< file and line of the request for a calibration; empty: none
  std::vector<Axis> axes;
  long long max_elements = MeshProblem{}.max_elements;  ///< of every case

  /// Throws InputError, with file and line, for a calibration of an unknown peer. Call it after all peers are
  /// known.
  void check_calibration() const;
  /// Throws InputError, with file and line, for a hypothesis about a pipeline that is not run. Also throws
  /// for two pipelines without a common domain with quads. Call it after all pipelines are known.
  void check_hypotheses() const;
  /// Returns pipelines by their texts: stages, and names of peers. Throws InputError for none, and for
  /// repeated ones.
  std::vector<Pipeline> find_pipelines(const std::vector<std::string>& texts) const;
  /// Reads the [[peer]] tables of a separate file; returns their names, which `parsed` does not have yet.
  /// Throws InputError with file and line.
  std::vector<std::string> add_peer_file(const std::filesystem::path& path);
  /// Returns the peer; null for a pipeline of stages.
  const Peer* peer_of(const Pipeline& pipeline) const;

  std::size_t n_cases() const { return cases_.size(); }
  std::size_t n_variants() const;  ///< of each case
  std::size_t n_cells() const { return n_cases() * n_variants() * parsed.size(); }
  /// Returns the file of the experiment and the files that it names beside it: models, published rows, files
  /// of peers and measures. Data of cases and missing files are left out.
  std::vector<std::filesystem::path> files() const;
  /// Returns the case of a variant; both indices count from 0. Throws InputError with file and line.
  Case read_variant(std::size_t index_of_case, std::size_t variant = 0) const;

  /// Reads an experiment. `data` is the folder of models that cases call data. `with_pipelines` finds the
  /// pipelines of the file; otherwise `parsed` stays empty. Throws InputError, with file and line, for
  /// anything against docs/experiments.md.
  static Experiment read(const std::filesystem::path& file, const std::filesystem::path& data = kDataFolder,
                         bool with_pipelines = true);

 private:
  friend StudyFile describe(const Experiment& experiment);
  void read_matrix(const TomlTable& matrix);
  void read_variants(const std::vector<TomlTable>& tables);
  void settle_calibration(const TomlTable& table);
  void add_peers(const std::vector<TomlTable>& tables, std::vector<Peer> added);
  void check_metrics(const TomlTable& table) const;
  void check_plan(const TomlTable& table) const;
  void check_hypothesis(const TomlTable& table, const Hypothesis& h) const;
  void check_may_fail(const TomlTable& table, const MayFail& cells) const;
  std::vector<Metric> known_metrics() const;
  std::vector<std::string> keys_of_metrics() const;
  Pipeline find_pipeline(const std::string& text) const;
  void check_comparisons(const TomlTable& table, const Case& c) const;

  /// Returns the digest of everything that determines results, except the order of cases and hypotheses.
  /// `study` has problems and geometries.
  std::string plan(const StudyFile& study) const;

  std::optional<TomlTable> table_;                  ///< the file
  Case defaults_;                                   ///< its values for every case
  PipelineStart start_ = PipelineStart::kBoundary;  ///< a given mesh if one of the cases has one
  std::vector<TomlTable> cases_;
  std::vector<TomlTable> variants_;  ///< named sets of keys, the first axis; empty: none
  std::optional<TomlTable> matrix_;
  std::vector<std::string> leaves_;           ///< of the matrix, in axes after the axis of variants
  std::vector<TomlTable> hypothesis_tables_;  ///< sources of hypotheses
};

/// Returns an axis by its title. Throws InputError, with file and line of the key, for an axis that does not
/// vary, and for the seed.
const Axis& find_axis(const std::vector<Axis>& axes, const std::string& title, const TomlTable& table,
                      const char* key);

/// Returns the description of the experiment for its folder of results.
StudyFile describe(const Experiment& experiment);

}  // namespace delquad
