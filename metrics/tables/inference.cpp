#include "metrics/tables/inference.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include "metrics/metrics.h"

namespace delquad {

namespace {

bool competes(const Samples& row, const std::string& key) {
  const auto is_rival = [&](const CellRecord* record) {
    return record->unsound.empty() && makes_quads(*record) &&
           !(is_of_quads(key) && leaves_triangles(*record));
  };
  return !row.done.empty() && std::ranges::all_of(row.done, is_rival);
}

}  // namespace

Marking::Marking(const std::vector<Samples>& samples, const std::vector<TestedMeasure>& measures,
                 ClaimFamily& family)
    : samples_(samples) {
  for (std::size_t first = 0, last; first < samples.size(); first = last) {
    last = first;
    while (last < samples.size() && samples[last].group == samples[first].group) ++last;
    for (const TestedMeasure& measure : measures)
      if (measure.metric.better != Better::kNeither) add_group(first, last, measure, family);
  }
}

void Marking::add_group(std::size_t first, std::size_t last, const TestedMeasure& measure,
                        ClaimFamily& family) {
  const std::string& key = measure.metric.key;
  Contest contest{key, measure.metric.better == Better::kHigher ? 1.0 : -1.0, {}, {}, {}};
  for (std::size_t i = first; i < last; ++i) {
    const bool is_time = measure.kind == ValueKind::kRepeatedTime;
    const std::vector<double> values = is_time ? samples_[i].times(key) : samples_[i].of(key);
    if (values.empty() || !competes(samples_[i], key)) continue;
    contest.rivals.push_back(i);
    contest.values.push_back(is_time ? median(values) : mean(values));
  }
  if (contest.rivals.size() < 2) return;
  for (const std::size_t b : contest.rivals)
    for (const std::size_t a : contest.rivals)
      if (a < b) contest.duels.push_back({a, b, family.add(test(measure, a, b))});
  contests_.push_back(std::move(contest));
}

RankTest Marking::test(const TestedMeasure& measure, std::size_t first, std::size_t second) const {
  const std::string& key = measure.metric.key;
  if (measure.kind == ValueKind::kRepeatedTime)
    return mann_whitney(samples_[first].times(key), samples_[second].times(key));
  return wilcoxon(pair_by_run(samples_[first].done, samples_[second].done, key));
}

bool Marking::can_prove(const ClaimFamily& family, const Contest& contest) {
  return std::ranges::any_of(contest.duels,
                             [&](const Duel& d) { return !std::isnan(family.adjusted_p(d.test)); });
}

bool Marking::can_prove(const ClaimFamily& family) const {
  return std::ranges::any_of(contests_, [&](const Contest& c) { return can_prove(family, c); });
}

void Marking::mark(const ClaimFamily& family, std::span<TableRow> rows) const {
  for (const Contest& contest : contests_) {
    if (!can_prove(family, contest)) continue;
    const auto [low, high] = std::ranges::minmax_element(contest.values);
    if (*low == *high) continue;
    std::size_t best = 0;
    for (std::size_t k = 1; k < contest.values.size(); ++k)
      if (contest.sign * (contest.values[k] - contest.values[best]) > 0) best = k;
    const std::size_t winner = contest.rivals[best];
    std::vector<std::size_t> as_good;
    for (const Duel& duel : contest.duels) {
      if (duel.first != winner && duel.second != winner) continue;
      const double lean = contest.sign * family.test(duel.test).lean * (duel.first == winner ? 1 : -1);
      if (family.finding(duel.test) != Finding::kProven || lean <= 0)
        as_good.push_back(duel.first == winner ? duel.second : duel.first);
    }
    rows[winner].marks[contest.key] = as_good.empty() ? Mark::kBest : Mark::kAsGoodAsBest;
    for (const std::size_t row : as_good) rows[row].marks[contest.key] = Mark::kAsGoodAsBest;
  }
}

std::vector<std::string> Marking::notes(const ClaimFamily& family, std::span<const TableRow> rows) const {
  if (contests_.empty()) return {};
  if (family.is_exploratory()) return {family.note() + " Nothing is marked."};
  bool best = false, as_good = false, single = true;
  for (const TableRow& row : rows)
    for (const auto& [key, mark] : row.marks) (mark == Mark::kBest ? best : as_good) = true;
  const bool too_few =
      std::ranges::any_of(contests_, [&](const Contest& c) { return !can_prove(family, c); });
  for (const Samples& row : samples_) single = single && row.done.size() < 2;
  std::vector<std::string> notes;
  if (best) notes.push_back("Bold: proven to be the best of its group, at 5 %.");
  if (as_good) notes.push_back("~: the best of its group, or not proven to be worse than it.");
  if (single && !best && !as_good)
    notes.push_back(
        "Single runs: a value that is better here need not be better on the same domain, turned a "
        "little. Nothing is marked as the best; that takes several seeds.");
  else if (too_few)
    notes.push_back("Where nothing is marked, all are alike or there are too few seeds to tell.");
  return notes;
}

namespace {

/// Compares runs with quads; in measures of quads alone those of pipelines that leave no triangles.
class Comparing {
 public:
  explicit Comparing(const std::vector<CellRecord>& records) : records_(records) {
    for (const CellRecord& record : records)
      if (record.reason.empty() && leaves_triangles(record)) with_triangles_.insert(record.pipeline);
  }

  PairComparison operator()(const std::string& along, const std::string& first, const std::string& second,
                            const TestedMeasure& measure) const {
    const std::string head = along.empty() ? "" : along + "=", &key = measure.metric.key;
    return {head + first, head + second, measure.metric,
            pair_by_domain(runs(along, first, key), runs(along, second, key), key, measure.kind, along), 0};
  }

 private:
  std::vector<const CellRecord*> runs(const std::string& along, const std::string& value,
                                      const std::string& key) const {
    std::vector<const CellRecord*> result;
    for (const CellRecord& record : records_)
      if (record.reason.empty() && makes_quads(record) && value_along(record, along) == value &&
          !(is_of_quads(key) && with_triangles_.contains(record.pipeline)))
        result.push_back(&record);
    return result;
  }

  const std::vector<CellRecord>& records_;
  std::set<std::string> with_triangles_;
};

/// Whether the first is proven to be better; not where the mean and most of the ranks disagree.
std::optional<bool> first_is_better(const PairComparison& pair, const ClaimFamily& family) {
  const double effect = mean(pair.domains.means());
  const double lean = family.test(pair.test).lean;
  if (family.finding(pair.test) != Finding::kProven || effect * lean <= 0) return std::nullopt;
  return (effect > 0) == (pair.metric.better == Better::kHigher);
}

/// What is said where the first is proven to be better, and to be worse.
using Words = std::array<const char*, 2>;

std::string in_words(const PairComparison& pair, const ClaimFamily& family, const Words& words) {
  if (family.is_exploratory()) return "exploratory";
  const std::vector<double> means = pair.domains.means();
  if (means.size() >= kFewestDomains && std::ranges::all_of(means, [](double d) { return d == 0; }))
    return "no difference";
  if (family.finding(pair.test) == Finding::kTooFew) return "too few domains";
  const auto better = first_is_better(pair, family);
  return !better ? "not proven" : *better ? words[0] : words[1];
}

TableRow row_of(const PairComparison& pair, const ClaimFamily& family, const Words& words) {
  const std::vector<double> means = pair.domains.means();
  const double sign = pair.metric.better == Better::kHigher ? 1 : -1, effect = mean(means);
  const auto count = [&](double side) {
    return static_cast<double>(std::ranges::count_if(means, [&](double d) { return side * sign * d > 0; }));
  };
  TableRow row{pair.first + " - " + pair.second, pair.metric.title, {}, {}, "", ""};
  row.values = {{"domains", static_cast<double>(means.size())},
                {"runs", static_cast<double>(pair.domains.runs)},
                {"better", count(1)},
                {"worse", count(-1)},
                {"effect", effect},
                {"p", family.test(pair.test).p},
                {"p_corrected", family.adjusted_p(pair.test)}};
  const auto interval = interval_of_mean(means);
  if (interval) {
    row.values["low"] = interval->low;
    row.values["high"] = interval->high;
    row.texts["effect"] = interval_text(effect, *interval, pair.metric.digits);
  }
  for (const char* key : {"p", "p_corrected"})
    if (!std::isnan(row.values[key])) row.texts[key] = p_text(row.values[key]);
  row.texts["first_is"] = in_words(pair, family, words);
  if (first_is_better(pair, family)) row.marks["effect"] = Mark::kBest;
  return row;
}

}  // namespace

std::vector<PairComparison> compare_pairs(const StudyFile& study, const std::vector<CellRecord>& records,
                                          const std::vector<TestedMeasure>& measures, ClaimFamily& family) {
  const Comparing compare(records);
  std::vector<PairComparison> pairs;
  const auto add_all = [&](const std::string& along, const std::vector<std::string>& values) {
    for (std::size_t i = 0; i < values.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        for (const TestedMeasure& measure : measures) {
          if (!along.empty() && measure.kind == ValueKind::kRepeatedTime) continue;
          PairComparison pair = compare(along, values[i], values[j], measure);
          if (pair.domains.names.size() < 2) continue;
          pair.test = family.add(wilcoxon(pair.domains.means()));
          pairs.push_back(std::move(pair));
        }
  };
  add_all("", study.pipelines);
  for (const auto& [title, values] : study.axes)
    if (std::ranges::find(study.pairs, title) != study.pairs.end()) add_all(title, values);
  return pairs;
}

namespace {

Table comparison_table(const std::string& title, const char* pairs, const char* verdict) {
  Table table{title, pairs, "measure", {}, {}, {}};
  table.columns = {{"domains", "domains", 0},
                   {"runs", "runs", 0},
                   {"better", "better", 0},
                   {"worse", "worse", 0},
                   {"effect", "difference", 4},
                   {"low", "low", 4},
                   {"high", "high", 4},
                   {"p", "p", 4},
                   {"p_corrected", "p corrected", 4},
                   {"first_is", verdict, 0}};
  table.shown = {"domains", "runs", "better", "worse", "effect", "p", "p_corrected", "first_is"};
  table.notes = {
      "First minus second, averaged over the seeds and variants of each domain (geometry); domains are the "
      "sample. Better, worse: on how many of them the first is. Difference: the mean of the domains, "
      "with its 95 % interval (bootstrap-t over domains, of fewer than six Student's)."};
  return table;
}

}  // namespace

Table pairs_table(const std::string& title, const std::vector<PairComparison>& pairs,
                  const ClaimFamily& family) {
  Table table = comparison_table(title + ": pairs of pipelines", "pipelines", "first is");
  const auto has_few = [](const PairComparison& pair) { return pair.domains.names.size() < kFewestDomains; };
  for (const PairComparison& pair : pairs) table.rows.push_back(row_of(pair, family, {"better", "worse"}));
  const bool says_nothing = std::ranges::all_of(pairs, has_few) && !family.is_exploratory();
  table.notes.push_back("p: Wilcoxon's signed-rank test over the domains, two-sided." +
                        (says_nothing ? "" : " " + family.note()));
  if (std::ranges::any_of(pairs, has_few))
    table.notes.push_back(fmt::format("With fewer than {} domains nothing can be proven.", kFewestDomains));
  return table;
}

Table hypotheses_table(const StudyFile& study, const Inference& inference) {
  Table table = comparison_table(study.title + ": hypotheses", "hypothesis", "verdict");
  for (const PairComparison& pair : inference.hypotheses()) {
    TableRow& row =
        table.rows.emplace_back(row_of(pair, inference.planned(pair.secondary), {"proven", "refuted"}));
    row.group = fmt::format("{} better than {}{}{}", pair.first, pair.second,
                            pair.one_sided ? "" : ", two-sided", pair.secondary ? ", secondary" : "");
  }
  const ClaimFamily &primary = inference.planned(false), &secondary = inference.planned(true);
  table.notes.emplace_back(
      "p: Wilcoxon's signed-rank test over the domains; one-sided, so that the contrary is never proven, but "
      "for hypotheses that say two-sided.");
  if (primary.size() > 0) table.notes.push_back(primary.note("of the primary hypotheses"));
  if (secondary.size() > 0)
    table.notes.push_back(
        "Secondary hypotheses count where all primary ones are proven: p corrected is no less than theirs. " +
        secondary.note("of the secondary hypotheses"));
  return table;
}

namespace {

constexpr const char* kSeconds = "seconds";
constexpr const char* kSecondsTotal = "seconds_total";
constexpr const char* kTauGiven = "tau_given";
constexpr int kTimeDigits = 2;
/// What the paper's tables show, with the counts, and what eta cannot see.
const std::vector<std::pair<const char*, int>> kColumns = {
    {"n_vertices", 0}, {"n_quads", 0}, {"n_triangles", 0},   {"eta_worst", 3},
    {"eta_mean", 3},   {"d4", 1},      {"d_min", 0},         {"d_max", 0},
    {"tau", 1},        {kTauGiven, 1}, {"percent_quads", 1}, {"aspect_max", 1},
    {"edge_min", 3}};
/// And what stages do that lessen irregular vertices.
constexpr const char* kRegularStages = "QKR";
const std::vector<const char*> kRegularity = {"n_irregular", "n_irregular_on_curves", "n_necessary",
                                              "n_beyond"};
/// What pairs of pipelines are compared by, beside measures of the study's own.
const std::vector<const char*> kCompared = {"eta_mean", "eta_worst", "d4", "tau"};

std::optional<Metric> metric_of(const std::string& key, const std::vector<Metric>& own) {
  if (const Metric* metric = find_metric(key)) return *metric;
  const auto at = std::ranges::find(own, key, &Metric::key);
  return at == own.end() ? std::nullopt : std::optional(*at);
}

void add_measure(const std::string& key, const std::vector<Metric>& own,
                 std::vector<TestedMeasure>& measures) {
  const std::optional<Metric> metric = metric_of(key, own);
  const bool known = std::ranges::any_of(measures, [&](const auto& m) { return m.metric.key == key; });
  if (metric && metric->better != Better::kNeither && !known) measures.push_back({*metric});
}

/// Only where runs were repeated is there anything to say of times.
void add_time(const StudyFile& study, std::vector<TestedMeasure>& measures) {
  if (study.repeat_times < 2) return;
  const char* key = time_key(study);
  measures.push_back(
      {{key, "s", "s", Better::kLower, std::nan(""), "", kTimeDigits}, ValueKind::kRepeatedTime});
}

}  // namespace

std::vector<TestedMeasure> marked_measures(const StudyFile& study, const std::vector<CellRecord>& records) {
  const std::vector<Metric> own = own_metrics_of(records);
  std::vector<TestedMeasure> measures;
  for (const TableColumn& column : table_columns(study, records)) add_measure(column.key, own, measures);
  add_time(study, measures);
  return measures;
}

std::vector<TestedMeasure> compared_measures(const StudyFile& study, const std::vector<CellRecord>& records) {
  const std::vector<Metric> own = own_metrics_of(records);
  std::vector<TestedMeasure> measures;
  for (const char* key : kCompared) add_measure(key, own, measures);
  for (const Metric& metric : own) add_measure(metric.key, own, measures);
  for (const std::string& key : study.columns) add_measure(key, own, measures);
  add_time(study, measures);
  return measures;
}

/// Wilcoxon's tests of all hypotheses, those of primary ones in the first family.
std::vector<PairComparison> compare_hypotheses(const StudyFile& study, const std::vector<CellRecord>& records,
                                               std::array<ClaimFamily, 2>& families) {
  const std::vector<Metric> own = own_metrics_of(records);
  std::vector<TestedMeasure> times;
  add_time(study, times);
  const Comparing compare(records);
  std::vector<PairComparison> all;
  for (const Hypothesis& h : study.hypotheses)
    for (const std::string& key : h.measures) {
      // Of a measure that no record knows there is nothing to compare.
      TestedMeasure measure = {metric_of(key, own).value_or(Metric{key, key, "", Better::kHigher, 0, ""})};
      if (!times.empty() && key == times[0].metric.key) measure = times[0];
      PairComparison pair = compare(h.along, h.better, h.than, measure);
      pair.one_sided = !h.two_sided;
      pair.secondary = h.secondary;
      const double sign = measure.metric.better == Better::kHigher ? 1 : -1;
      std::vector<double> gains = pair.domains.means();
      for (double& gain : gains) gain *= sign;
      RankTest test = wilcoxon(gains, pair.one_sided);
      test.lean *= sign;
      pair.test = families[h.secondary ? 1 : 0].add(test);
      all.push_back(std::move(pair));
    }
  return all;
}

Interval range_of(const std::string& key) {
  if (key.starts_with("eta_")) return {0, 1};
  if (key.starts_with("scaled_jacobian_")) return {-1, 1};
  static const std::vector<std::string> percentages = {"d4", "tau", kTauGiven, "percent_quads"};
  if (std::ranges::find(percentages, key) != percentages.end()) return {0, 100};
  if (key.starts_with("aspect_")) return {1, HUGE_VAL};
  if (key.starts_with("n_") || key.starts_with("seconds") || key == "edge_min" || key == kFinishSeconds)
    return {0, HUGE_VAL};
  return TableColumn().range;
}

namespace {

void add_times(const StudyFile& study, std::vector<TableColumn>& columns) {
  const bool repeated = study.repeat_times > 0;
  if (study.step_times) {
    for (const StepTime& step : step_times_of_tables())
      columns.push_back({step.key, step.title, kTimeDigits});
    columns.push_back({kFinishSeconds, "finish s", kTimeDigits});
  } else
    columns.push_back({kSeconds, repeated ? "s, median" : "s", kTimeDigits});
  if (repeated)
    columns.push_back({kLeastTime, study.step_times ? "total s, least" : "s, least", kTimeDigits});
}

}  // namespace

const char* time_key(const TablePlan& study) { return study.step_times ? kSecondsTotal : kSeconds; }

std::vector<TableColumn> table_columns(const StudyFile& study, const std::vector<CellRecord>& records) {
  const bool adapted =
      std::ranges::any_of(records, [](const CellRecord& record) { return !record.size_adapted_to.empty(); });
  const std::vector<Metric> own = own_metrics_of(records);
  std::vector<TableColumn> columns = {{kRuns, "n", 0}};
  for (const auto& [key, digits] : kColumns) {
    const Metric* metric = find_metric(key);
    if (key == std::string(kTauGiven) && !adapted) continue;
    columns.push_back({key, metric == nullptr ? key : metric->title, digits});
  }
  if (std::ranges::any_of(records, [](const CellRecord& record) {
        return record.pipeline.find_first_of(kRegularStages) != std::string::npos;
      }))
    for (const char* key : kRegularity) columns.push_back({key, find_metric(key)->title, 0});
  for (const Metric& metric : own) columns.push_back({metric.key, metric.title, metric.digits});
  add_times(study, columns);
  for (const std::string& key : study.columns) {
    if (std::ranges::find(columns, key, &TableColumn::key) != columns.end()) continue;
    if (key == kSeconds) columns.push_back({key, "s", kTimeDigits});
    for (const Metric& metric : columns_of_records())
      if (key == metric.key) columns.push_back({key, metric.title, metric.digits});
    if (const auto metric = metric_of(key, own)) columns.push_back({key, metric->title, metric->digits});
    for (const StepTime& step : step_times_of_tables())
      if (key == step.key) columns.push_back({key, step.title, kTimeDigits});
  }
  for (TableColumn& column : columns)
    if (std::ranges::find(own, column.key, &Metric::key) == own.end()) column.range = range_of(column.key);
  return columns;
}

Inference::Inference(const StudyFile& study, const std::vector<CellRecord>& records)
    : samples_(group_samples(records)),
      marking_(samples_, marked_measures(study, records), family_),
      pairs_(compare_pairs(study, records, compared_measures(study, records), family_)),
      hypotheses_(compare_hypotheses(study, records, planned_)) {
  study.hypotheses.empty() ? family_.decide() : family_.explore();
  planned_[0].decide();
  planned_[1].decide(planned_[0].largest_p());
}

std::optional<bool> Inference::first_is_better(const PairComparison& pair) const {
  if (!family_.is_exploratory()) return delquad::first_is_better(pair, family_);
  for (const PairComparison& planned : hypotheses_) {
    const bool is_same = planned.first == pair.first && planned.second == pair.second;
    if (planned.metric.key != pair.metric.key ||
        !(is_same || (planned.first == pair.second && planned.second == pair.first)))
      continue;
    if (const auto better = delquad::first_is_better(planned, planned_[planned.secondary ? 1 : 0]))
      return *better == is_same;
  }
  return std::nullopt;
}

}  // namespace delquad
