#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "delquad/metrics.h"
#include "metrics/tables/samples.h"
#include "metrics/tables/statistics.h"
#include "metrics/tables/study_file.h"
#include "metrics/tables/table.h"

namespace delquad {

/// A measure of tables that is better one way, and how it is tested.
struct TestedMeasure {
  Metric metric;
  ValueKind kind = ValueKind::kMeasure;
};

/// Which values of each group (a variant of a case) are proven to be the best.
///
/// Rivals are rows of sound meshes of quads; for measures of quads alone only those without triangles. Every
/// two of a group are tested against each other, by Wilcoxon's signed-rank test over the seeds that both
/// have, and times by the Mann-Whitney U test over repeated runs: whoever turns out to be the best, that test
/// is among them.
class Marking {
 public:
  /// Adds its tests to the family. `samples` has to outlive it.
  Marking(const std::vector<Samples>& samples, const std::vector<TestedMeasure>& measures,
          ClaimFamily& family);

  /// `rows`: of the samples, in the same order. The best value is marked as such where it is proven to be
  /// better than every rival; else it and what is not proven to be worse are marked as good; nothing is
  /// marked where there were too few runs to tell anything.
  void mark(const ClaimFamily& family, std::span<TableRow> rows) const;
  /// Whether any of its tests could prove a difference.
  bool can_prove(const ClaimFamily& family) const;
  /// For people: what the marks of these rows mean, and why there are none.
  std::vector<std::string> notes(const ClaimFamily& family, std::span<const TableRow> rows) const;

 private:
  struct Duel {
    std::size_t first, second;  ///< rows
    std::size_t test;           ///< of the family
  };
  /// A measure in a group.
  struct Contest {
    std::string key;
    double sign;                      ///< 1 where more is better, -1 where less is
    std::vector<std::size_t> rivals;  ///< rows
    std::vector<double> values;       ///< of the rivals
    std::vector<Duel> duels;
  };

  static bool can_prove(const ClaimFamily& family, const Contest& contest);
  void add_group(std::size_t first, std::size_t last, const TestedMeasure& measure, ClaimFamily& family);
  RankTest test(const TestedMeasure& measure, std::size_t first, std::size_t second) const;

  const std::vector<Samples>& samples_;
  std::vector<Contest> contests_;
};

/// With fewer domains Wilcoxon's test can prove nothing at 5 %.
inline constexpr std::size_t kFewestDomains = 6;

/// Two pipelines, or two values of an axis, in one measure, over the domains on which both have a value. The
/// sample is the domain: the differences of its seeds are averaged, then those of its variants (along an axis
/// of all pipelines), since neither are independent of each other.
struct PairComparison {
  std::string first, second;
  Metric metric;
  PairedDomains domains;                      ///< first minus second
  std::size_t test;                           ///< of its family: Wilcoxon's over the means of the domains
  bool one_sided = false, secondary = false;  ///< of hypotheses
};

/// Every two pipelines, and values of the axes that the study asks for, that share two domains or more, in
/// every measure; of quads alone those of pipelines that leave no triangles. Unsound meshes count as they
/// are. Times are compared of pipelines alone. Adds a test to the family for each.
std::vector<PairComparison> compare_pairs(const StudyFile& study, const std::vector<CellRecord>& records,
                                          const std::vector<TestedMeasure>& measures, ClaimFamily& family);

/// A row for each: domains and runs, on how many domains the first is better and worse, the mean of the
/// domains' means with its 95 % interval, p-values, and what is proven, in words.
Table pairs_table(const std::string& title, const std::vector<PairComparison>& pairs,
                  const ClaimFamily& family);

/// Everything that the tables of a study may claim: of the marks in its table and the pairs of its pipelines,
/// as one family of tests; where it has hypotheses, these alone. See docs/statistics.md.
class Inference {
 public:
  /// `records` have to outlive it.
  Inference(const StudyFile& study, const std::vector<CellRecord>& records);
  Inference(const Inference&) = delete;
  Inference& operator=(const Inference&) = delete;

  const std::vector<Samples>& samples() const { return samples_; }
  const ClaimFamily& family() const { return family_; }
  const Marking& marking() const { return marking_; }
  const std::vector<PairComparison>& pairs() const { return pairs_; }
  /// A test for each measure of each hypothesis, in their order, whatever there is to test.
  const std::vector<PairComparison>& hypotheses() const { return hypotheses_; }
  /// Of the hypotheses that are primary, or secondary: these are claimed only where the others all are.
  const ClaimFamily& planned(bool secondary) const { return planned_[secondary ? 1 : 0]; }
  /// Whether the first is proven to be better, or worse; nothing where neither is, or the mean and most of
  /// the ranks disagree. Of a study with hypotheses it is what they say of these two.
  std::optional<bool> first_is_better(const PairComparison& pair) const;

 private:
  std::vector<Samples> samples_;
  ClaimFamily family_;
  Marking marking_;
  std::vector<PairComparison> pairs_;
  std::array<ClaimFamily, 2> planned_;
  std::vector<PairComparison> hypotheses_;
};

/// What values of a table are marked by, within a variant, and what pairs are compared by, over domains.
std::vector<TestedMeasure> marked_measures(const StudyFile& study, const std::vector<CellRecord>& records);
std::vector<TestedMeasure> compared_measures(const StudyFile& study, const std::vector<CellRecord>& records);
/// What no value of a measure of the project's own can leave.
Interval range_of(const std::string& key);
/// As pairs_table(), of what was planned.
Table hypotheses_table(const StudyFile& study, const Inference& inference);

/// Its columns: of how many runs, what the paper's tables show, measures of the study's own, those that it
/// asks for, and times.
std::vector<TableColumn> table_columns(const StudyFile& study, const std::vector<CellRecord>& records);
/// The key under which tables show the time of a run: of the stages alone, or of all steps.
const char* time_key(const TablePlan& study);
/// Of the least of repeated runs.
inline constexpr const char* kLeastTime = "seconds_least";

}  // namespace delquad
