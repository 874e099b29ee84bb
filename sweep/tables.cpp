#include "sweep/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <set>

#include "delquad/error.h"
#include "io/mesh_io.h"
#include "metrics/metrics.h"
#include "sweep/calibration_notes.h"
#include "sweep/statistics.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSeed = "seed";  // the axis whose values are samples of the same thing
constexpr double kSignificance = 0.05;
/// With fewer pairs Wilcoxon's test can prove nothing at 5 %.
constexpr std::size_t kFewestPairs = 6;

constexpr const char* kSeconds = "seconds";
constexpr const char* kTauGiven = "tau_given";
/// What the paper's tables show, then the counts and the time.
const std::vector<std::pair<const char*, int>> kColumns = {
    {"n_vertices", 0}, {"n_quads", 0}, {"n_triangles", 0}, {"eta_worst", 3}, {"eta_mean", 3},     {"d4", 1},
    {"d_min", 0},      {"d_max", 0},   {"tau", 1},         {kTauGiven, 1},   {"percent_quads", 1}};
/// What pairs of pipelines are compared by.
const std::vector<const char*> kCompared = {"eta_mean", "eta_worst", "d4", "tau", kSeconds};

/// With a column for each step's time, or one for the stages of the pipeline; and one for tau against the
/// size as it was given, where that is another than what it was measured against.
std::vector<TableColumn> table_columns(bool step_times, bool sizes_adapted, const std::vector<Metric>& own) {
  std::vector<TableColumn> columns;
  for (const auto& [key, digits] : kColumns) {
    const Metric* metric = find_metric(key);
    if (key == std::string(kTauGiven) && !sizes_adapted) continue;
    columns.push_back({key, metric == nullptr ? key : metric->title, digits});
  }
  for (const Metric& metric : own) columns.push_back({metric.key, metric.title, metric.digits});
  if (!step_times) {
    columns.push_back({kSeconds, "s", 2});
    return columns;
  }
  for (const StepTime& step : step_times_of_tables()) columns.push_back({step.key, step.title, 2});
  return columns;
}

double value_of(const CellRecord& record, const std::string& key) {
  const auto at = record.values.find(key);
  return at == record.values.end() ? std::nan("") : at->second;
}

bool makes_quads(const CellRecord& record) { return value_of(record, "n_quads") > 0; }

/// The case and what else tells the samples of a row from those of others.
std::string row_group(const CellRecord& record) {
  std::string group = record.name;
  for (const auto& [title, value] : record.variant)
    if (title != kSeed) group += fmt::format(", {}={}", title, value);
  return group;
}

/// The cells of one row: a pipeline on a variant, with every seed.
struct Samples {
  std::string group, pipeline;
  std::vector<const CellRecord*> done, skipped, failed;

  std::vector<double> of(const std::string& key) const {
    std::vector<double> values;
    for (const CellRecord* record : done)
      if (const double v = value_of(*record, key); !std::isnan(v)) values.push_back(v);
    return values;
  }
};

std::vector<Samples> group_samples(const std::vector<CellRecord>& records) {
  std::vector<Samples> rows;
  std::map<std::pair<std::string, std::string>, std::size_t> known;
  for (const CellRecord& record : records) {
    const std::string group = row_group(record);
    const auto [at, is_new] = known.try_emplace({group, record.pipeline}, rows.size());
    if (is_new) rows.push_back({group, record.pipeline, {}, {}, {}});
    Samples& row = rows[at->second];
    (record.reason.empty() ? row.done : record.skipped ? row.skipped : row.failed).push_back(&record);
  }
  // Groups stay together: by the first of their cells.
  std::map<std::string, std::size_t> order;
  for (const Samples& row : rows) order.try_emplace(row.group, order.size());
  std::ranges::stable_sort(rows, {}, [&](const Samples& row) { return order.at(row.group); });
  return rows;
}

/// a - b of every case, variant and seed on which both have a value.
std::vector<double> differences(const std::vector<const CellRecord*>& a,
                                const std::vector<const CellRecord*>& b, const std::string& key) {
  std::map<std::string, double> others;
  for (const CellRecord* record : b) others[record->group] = value_of(*record, key);
  std::vector<double> result;
  for (const CellRecord* record : a)
    if (const auto at = others.find(record->group); at != others.end())
      if (const double d = value_of(*record, key) - at->second; !std::isnan(d)) result.push_back(d);
  return result;
}

/// Marks the best value of each measure among the rows of a group that make quads, and sound meshes.
void mark_best(const std::vector<Metric>& metrics, std::span<const Samples> samples,
               std::span<TableRow> rows) {
  for (const Metric& metric : metrics) {
    if (metric.better == Better::kNeither) continue;
    const std::string& key = metric.key;
    const double sign = metric.better == Better::kHigher ? 1 : -1;
    std::vector<std::size_t> rivals;
    for (std::size_t i = 0; i < rows.size(); ++i)
      if (rows[i].values.contains(key) && rows[i].unsound.empty() && makes_quads(*samples[i].done[0]))
        rivals.push_back(i);
    const auto score = [&](std::size_t i) { return sign * rows[i].values.at(key); };
    const auto [worst, best] = std::ranges::minmax_element(rivals, {}, score);
    if (rivals.empty() || score(*worst) == score(*best)) continue;
    for (const std::size_t i : rivals) {
      if (score(i) == score(*best)) {
        rows[i].marks[key] = Mark::kBest;
      } else if (samples[i].done.size() > 1 &&
                 wilcoxon_p(differences(samples[*best].done, samples[i].done, key)) > kSignificance) {
        rows[i].marks[key] = Mark::kAsGoodAsBest;
      }
    }
  }
}

class Tabulation {
 public:
  Tabulation(const StudyFile& study, const std::vector<CellRecord>& records)
      : study_(study), records_(records), samples_(group_samples(records)), own_(own_metrics_of(records)) {}

  Outcome run() {
    Table& table = outcome_.table;
    table.title = study_.title;
    table.columns =
        table_columns(study_.step_times,
                      std::ranges::any_of(
                          records_, [](const CellRecord& record) { return !record.size_adapted_to.empty(); }),
                      own_);
    for (const PublishedRow& row : study_.published)
      table.rows.push_back({"published", row.name, row.values, {}, row.source, ""});
    const std::size_t first = table.rows.size();
    for (const Samples& row : samples_) add_row(row);
    mark_groups(std::span(table.rows).subspan(first));
    note_cells();
    note_failed_metrics();
    if (study_.ratio) note_ratio(*study_.ratio);
    compare_pairs();
    return std::move(outcome_);
  }

 private:
  void add_row(const Samples& samples) {
    TableRow row{samples.group, samples.pipeline, {}, {}, "", ""};
    for (const CellRecord* failed : samples.failed)
      ++(failed->kind == "bad input" ? outcome_.bad_inputs
         : failed->kind == "unsound" ? outcome_.unsound
                                     : outcome_.others_failed);
    if (samples.done.empty()) {
      if (samples.failed.empty())
        row.skipped = samples.skipped[0]->kind;
      else
        row.failure = samples.failed[0]->reason;
    } else {
      for (const TableColumn& column : outcome_.table.columns) add_value(samples, column.key, row);
      const auto unsound = std::ranges::count_if(samples.done, [](auto* r) { return !r->unsound.empty(); });
      if (unsound > 0)
        row.unsound = samples.done.size() == 1
                          ? "unsound"
                          : fmt::format("{} of {} unsound", unsound, samples.done.size());
      if (!samples.failed.empty())
        outcome_.table.notes.push_back(fmt::format(
            "{} {}: {} of {} runs failed, the first: {}", samples.group, samples.pipeline,
            samples.failed.size(), samples.failed.size() + samples.done.size(), samples.failed[0]->reason));
      if (samples.done[0]->quads_only)
        for (const double n : samples.of("n_triangles"))
          outcome_.leftover_triangles += static_cast<long long>(n);
    }
    add_published(samples, row);
    outcome_.table.rows.push_back(std::move(row));
  }

  static void add_value(const Samples& samples, const std::string& key, TableRow& row) {
    const std::vector<double> values = samples.of(key);
    if (values.empty()) return;
    row.values[key] = mean(values);
    if (values.size() > 1) row.half_widths[key] = confidence_half_width(values);
  }

  void add_published(const Samples& samples, TableRow& row) const {
    const auto& records = !samples.done.empty()     ? samples.done
                          : !samples.failed.empty() ? samples.failed
                                                    : samples.skipped;
    const auto words = study_.compare.find(records[0]->name);
    if (words == study_.compare.end() || samples.done.empty()) return;
    const auto name = words->second.find(samples.pipeline);
    if (name == words->second.end()) return;
    for (const PublishedRow& published : study_.published)
      if (published.name == name->second) {
        row.published = published.values;
        row.source = published.name + ", " + published.source;
      }
  }

  void mark_groups(std::span<TableRow> rows) const {
    std::vector<Metric> metrics = own_;
    for (const auto& [key, digits] : kColumns)
      if (const Metric* metric = find_metric(key)) metrics.push_back(*metric);
    for (std::size_t first = 0, last; first < rows.size(); first = last) {
      last = first;
      while (last < rows.size() && rows[last].group == rows[first].group) ++last;
      mark_best(metrics, std::span(samples_).subspan(first, last - first), rows.subspan(first, last - first));
    }
  }

  /// What there is to say of single cells, and of those that are not there.
  void note_cells() {
    std::vector<std::string>& notes = outcome_.table.notes;
    std::set<std::string> said;
    const auto say = [&](const std::string& text) {
      if (said.insert(text).second) notes.push_back(text);
    };
    for (const CellRecord& record : records_) {
      if (record.kind == kNotApplicable)
        say(fmt::format("{} {} is not applicable: {}", record.group, record.pipeline, record.reason));
      else if (record.skipped)
        say(fmt::format("{}: {}", record.name, record.reason));
      say_size(record, say);
      for (const std::string& reason : record.unsound)
        say(fmt::format("{} {} is not sound: {}", record.group, record.pipeline, reason));
      for (const std::string& warning : record.warnings)
        if (warning.starts_with(record.name + " ")) say("warning: " + warning);
    }
    for (const std::string& note : calibration_notes(records_)) say(note);
    if (records_.size() < study_.cells)
      notes.push_back(
          fmt::format("{} of {} cells have no result yet", study_.cells - records_.size(), study_.cells));
  }

  /// Of each measure that has no value somewhere: where, and why.
  void note_failed_metrics() {
    std::map<std::string, std::pair<std::size_t, std::string>> failed;  // how often, the first
    for (const CellRecord& record : records_)
      for (const auto& [key, reason] : record.failed_metrics) {
        auto& [count, first] = failed[key];
        if (count++ == 0) first = fmt::format("{} {}: {}", record.group, record.pipeline, reason);
      }
    for (const auto& [key, entry] : failed)
      outcome_.table.notes.push_back(entry.first == 1 ? fmt::format("no '{}' of {}", key, entry.second)
                                                      : fmt::format("no '{}' of {} cells, the first {}", key,
                                                                    entry.first, entry.second));
  }

  /// Against which size tau is measured.
  template <class Say>
  static void say_size(const CellRecord& record, const Say& say) {
    const bool uniform = !record.uniform_size.empty() && record.variant.empty();
    if (record.size_adapted_to.empty()) {
      if (uniform) say(fmt::format("{}: uniform delta = {}", record.name, record.uniform_size));
      return;
    }
    say(fmt::format(
        "{}: delta{} was made smaller for {}: tau is measured against that, tau given against "
        "delta as it was given",
        record.name, uniform ? " = " + record.uniform_size : "", fmt::join(record.size_adapted_to, " and ")));
  }

  void note_ratio(const ExpectedRatio& ratio) {
    for (const Samples& a : samples_) {
      if (a.pipeline != ratio.numerator) continue;
      for (const Samples& b : samples_) {
        if (b.pipeline != ratio.denominator || b.group != a.group) continue;
        const std::vector<double> above = a.of(ratio.metric), below = b.of(ratio.metric);
        if (above.empty() || below.empty() || mean(below) == 0) continue;
        const double quotient = mean(above) / mean(below);
        outcome_.table.notes.push_back(fmt::format(
            "{}: {} of {} / {} = {:.4f}; expected {:.4f} ({:+.2f} %{}{})", a.group, ratio.metric,
            ratio.numerator, ratio.denominator, quotient, ratio.expected,
            100 * (quotient / ratio.expected - 1), ratio.source.empty() ? "" : "; ", ratio.source));
      }
    }
  }

  /// Every two pipelines that make quads, over all cases, variants and seeds.
  void compare_pairs() {
    Table& table = outcome_.pairs;
    table = {study_.title + ": pairs of pipelines", "pipelines", "measure", {}, {}, {}};
    table.columns = {{"pairs", "pairs", 0},
                     {"better", "better", 0},
                     {"worse", "worse", 0},
                     {"median", "median difference", 4},
                     {"p", "p", 4}};
    std::map<std::string, std::vector<const CellRecord*>> by_word;
    for (const CellRecord& record : records_)
      if (record.reason.empty() && makes_quads(record)) by_word[record.pipeline].push_back(&record);
    for (std::size_t i = 0; i < study_.pipelines.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) add_pair(study_.pipelines[i], study_.pipelines[j], by_word);
    if (!table.rows.empty())
      table.notes.push_back(
          "Over all cases, variants and seeds that both ran on: how often the first is better and worse than "
          "the "
          "second, the median of first minus second, and the p-value of Wilcoxon's signed-rank test.");
  }

  void add_pair(const std::string& first, const std::string& second,
                const std::map<std::string, std::vector<const CellRecord*>>& by_word) {
    const auto a = by_word.find(first), b = by_word.find(second);
    if (a == by_word.end() || b == by_word.end()) return;
    std::vector<Metric> metrics;
    for (const char* key : kCompared) {
      const Metric* metric = find_metric(key);
      const double none = std::nan("");
      metrics.push_back(metric == nullptr ? Metric{key, key, "", Better::kLower, none, ""} : *metric);
    }
    for (const Metric& metric : own_)
      if (metric.better != Better::kNeither) metrics.push_back(metric);
    for (const Metric& metric : metrics) {
      const std::string& key = metric.key;
      const std::vector<double> d = differences(a->second, b->second, key);
      if (d.size() < kFewestPairs) continue;
      const double sign = metric.better == Better::kHigher ? 1 : -1;
      TableRow row{first + " - " + second, metric.title, {}, {}, "", ""};
      row.values = {
          {"pairs", static_cast<double>(d.size())},
          {"better", static_cast<double>(std::ranges::count_if(d, [&](double x) { return sign * x > 0; }))},
          {"worse", static_cast<double>(std::ranges::count_if(d, [&](double x) { return sign * x < 0; }))},
          {"median", median(d)},
          {"p", wilcoxon_p(d)}};
      if (row.values["p"] > kSignificance) row.marks["p"] = Mark::kAsGoodAsBest;
      outcome_.pairs.rows.push_back(std::move(row));
    }
  }

  const StudyFile& study_;
  const std::vector<CellRecord>& records_;
  std::vector<Samples> samples_;
  std::vector<Metric> own_;
  Outcome outcome_;
};

bool contains(const std::vector<std::string>& list, const std::string& name) {
  return std::ranges::find(list, name) != list.end();
}

/// Whether the experiment still has the cell.
bool belongs(const StudyFile& study, const CellRecord& record) {
  return contains(study.cases, record.name) && contains(study.pipelines, record.pipeline) &&
         std::ranges::equal(record.variant, study.axes, [](const auto& value, const auto& axis) {
           return value.first == axis.first && contains(axis.second, value.second);
         });
}

}  // namespace

StudyResults read_results(const fs::path& folder) {
  StudyResults results;
  results.records = read_records(folder);
  std::optional<StudyFile> study = read_study(folder);
  if (!study)
    throw InputError((folder / "study.json").string() +
                     ": is missing: expected the folder of 'delquad run -o'");
  results.study = *std::move(study);
  results.left_out =
      std::erase_if(results.records, [&](const CellRecord& r) { return !belongs(results.study, r); });
  return results;
}

Outcome make_tables(const StudyResults& results) {
  Outcome outcome = Tabulation(results.study, results.records).run();
  if (results.left_out > 0)
    outcome.table.notes.push_back(
        fmt::format("{} records of cells that the experiment no longer has are left out", results.left_out));
  return outcome;
}

Outcome make_tables(const fs::path& folder) { return make_tables(read_results(folder)); }

std::vector<std::string> write_tables(const fs::path& folder, const Outcome& outcome) {
  std::vector<std::string> errors;
  for (const auto& [name, table] : {std::pair("table", &outcome.table), std::pair("pairs", &outcome.pairs)})
    for (const TableFormat& format : table_formats()) {
      const fs::path file = folder / (std::string(name) + format.extension);
      try {
        if (!table->rows.empty())
          write_file_atomically(file, [&](std::ostream& out) { out << format.print(*table); });
      } catch (const InputError& error) {
        errors.push_back(error.what());
      }
    }
  return errors;
}

std::vector<std::string> result_files() {
  std::vector<std::string> files = {"study.json"};
  for (const char* name : {"table", "pairs"})
    for (const TableFormat& format : table_formats()) files.push_back(std::string(name) + format.extension);
  return files;
}

}  // namespace delquad
