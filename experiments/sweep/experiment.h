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
  std::string title;                ///< its last part, or as much as tells it from the others
  std::vector<std::string> values;  ///< as texts
};

/// A file of experiments/: cases, the pipelines to run on each, and what was published.
///
/// Each case comes in as many variants as the [matrix] has combinations (one without a matrix). Variants are
/// read when they are asked for: a sweep may have many.
class Experiment : public TablePlan, public ExperimentKeys {
 public:
  std::filesystem::path file;
  std::vector<Word> words;      ///< and peers, as words without stages
  std::string calibrate_where;  ///< file and line that ask for a calibration; empty: nothing does
  std::vector<Axis> axes;
  long long max_elements = MeshProblem{}.max_elements;  ///< of every case

  /// Throws InputError with file and line where a calibration is asked for that is none of any peer. To be
  /// called when all peers are there.
  void check_calibration() const;
  /// Throws InputError with file and line for a hypothesis about a pipeline that is not run. So it does for a
  /// hypothesis about two pipelines that have no domain with quads in common. To be called when all pipelines
  /// are known.
  void check_hypotheses() const;
  /// Pipelines by their texts: words, and names of peers. Throws InputError for none, and for one given
  /// twice.
  std::vector<Word> find_pipelines(const std::vector<std::string>& texts) const;
  /// Reads the [[peer]] tables of a file of their own; returns their names, which `words` does not have yet.
  /// Throws InputError with file and line.
  std::vector<std::string> add_peer_file(const std::filesystem::path& path);
  /// Returns the peer; null for a word of stages.
  const Peer* peer_of(const Word& word) const;

  std::size_t n_cases() const { return cases_.size(); }
  std::size_t n_variants() const;  ///< of each case
  std::size_t n_cells() const { return n_cases() * n_variants() * words.size(); }
  /// Returns the experiment's file and all that it names beside it: models, published rows, files of peers
  /// and measures. Without those that cases call data and those that are not there.
  std::vector<std::filesystem::path> files() const;
  /// Throws InputError with file and line.
  Case read_variant(std::size_t index_of_case, std::size_t variant = 0) const;

  /// Reads an experiment. `data`: the folder of the models that cases call data. `with_pipelines`: finds the
  /// pipelines of the file; otherwise `words` stays empty. Throws InputError with file and line for anything
  /// that is not as docs/experiments.md says.
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
  Word find_pipeline(const std::string& text) const;
  void check_comparisons(const TomlTable& table, const Case& c) const;

  /// Returns the digest of all that determines the results, except the order of cases and hypotheses.
  /// `study`: with problems and geometries.
  std::string plan(const StudyFile& study) const;

  std::optional<TomlTable> table_;               ///< the file
  Case defaults_;                                ///< what it says for every case
  WordStart word_start_ = WordStart::kBoundary;  ///< a given mesh, where one of the cases has one
  std::vector<TomlTable> cases_;
  std::vector<TomlTable> variants_;  ///< named sets of keys, the first axis; empty: none
  std::optional<TomlTable> matrix_;
  std::vector<std::string> leaves_;           ///< of the matrix, in axes after the axis of variants
  std::vector<TomlTable> hypothesis_tables_;  ///< that hypotheses were read from
};

/// Returns an axis by its title. Throws InputError with file and line of the key for one that does not vary,
/// and the seed.
const Axis& find_axis(const std::vector<Axis>& axes, const std::string& title, const TomlTable& table,
                      const char* key);

/// Returns the description of the experiment for its folder of results.
StudyFile describe(const Experiment& experiment);

}  // namespace delquad
