// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/tables/runs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "metrics/tables/inference.h"

namespace delquad {
namespace {

struct RunColumn {
  Metric metric;     ///< key, title, unit, better direction; `source` has the meaning
  Interval range;    ///< range of numbers
  const char* type;  ///< "text" or "number"
  std::function<std::string(const CellRecord&)> field;  ///< quoted if needed
};

std::string status_of(const CellRecord& record) {
  if (record.reason.empty()) return record.unsound.empty() ? "ok" : "unsound";
  return !record.skipped ? "failed" : record.kind == kNotApplicable ? kNotApplicable : "skipped";
}

/// Returns the kind of failure and the first line of its text, in one line.
std::string reason_of(const CellRecord& record) {
  if (record.reason.empty()) return fmt::format("{}", fmt::join(record.unsound, "; "));
  const std::string text = record.reason.substr(0, record.reason.find('\n'));
  return record.kind.empty() || text.starts_with(record.kind) ? text : record.kind + ": " + text;
}

std::string value_of_axis(const CellRecord& record, const std::string& title) {
  const auto at = std::ranges::find(record.variant, title, &std::pair<std::string, std::string>::first);
  return at == record.variant.end() ? "" : at->second;
}

class RunColumns {
 public:
  RunColumns(const StudyFile& study, const std::vector<CellRecord>& records)
      : study_(study), compared_(compared_measures(study, records)) {
    add_texts(study);
    for (const Metric& metric : metric_registry()) add(metric);
    for (const Metric& metric : added_metrics_of(records)) add(metric);
    for (const Metric& metric : columns_of_records()) add(metric);
  }

  RunsCsv csv(const std::vector<CellRecord>& records) const {
    RunsCsv csv{"", "column,title,meaning,unit,type,least,most,better,of_quads,tested\n"};
    for (const RunColumn& column : columns_) {
      csv.lines += (csv.lines.empty() ? "" : ",") + csv_quoted(column.metric.key);
      csv.columns += description(column);
    }
    csv.lines += "\n";
    for (const CellRecord& record : records)
      for (const RunColumn& column : columns_)
        csv.lines += column.field(record) + (&column == &columns_.back() ? "\n" : ",");
    return csv;
  }

 private:
  void add_text(const std::string& key, const std::string& meaning,
                std::function<std::string(const CellRecord&)> text, const char* type = "text") {
    columns_.push_back({{key, key, "", Better::kNeither, std::nan(""), meaning},
                        TableColumn().range,
                        type,
                        [text = std::move(text)](const CellRecord& r) { return csv_quoted(text(r)); }});
  }

  void add_texts(const StudyFile& study) {
    add_text("case", "its name in the experiment", [](const CellRecord& r) { return r.name; });
    add_text("domain", "what counts as one in claims: the first case of the same geometry", domain_of);
    add_text("model", "digest of what the case is made from", [](const CellRecord& r) { return r.model; });
    add_text("pipeline", "the pipeline, or the name of the peer",
             [](const CellRecord& r) { return r.pipeline; });
    add_text("kind", "word (a pipeline) or peer",
             [](const CellRecord& r) -> std::string { return r.is_peer ? "peer" : "word"; });
    for (const auto& [title, values] : study.axes)
      if (title != kSeedAxis)
        add_text(title, "an axis of [matrix]",
                 [key = title](const CellRecord& r) { return value_of_axis(r, key); });
    add_text(
        kSeedAxis, "0: the domain as it is; else what changes it a little at random",
        [](const CellRecord& r) { return fmt::format("{}", r.seed); }, "number");
    add_text("status", "ok, unsound (a mesh with faults), failed, skipped or not applicable", status_of);
    add_text("reason", "for the status", reason_of);
  }

  void add(const Metric& metric) {
    columns_.push_back({metric, range_of_metric(metric), "number",
                        [key = metric.key](const CellRecord& r) { return csv_number(value_of(r, key)); }});
    if (metric.source.empty()) columns_.back().metric.source = "a measure of the experiment";
  }

  static Interval range_of_metric(const Metric& metric) {
    const Interval known = range_of(metric.key);
    if (std::isfinite(known.low)) return known;
    const bool counts = metric.key.starts_with("n_") || metric.unit == "s";
    return {metric.better == Better::kHigher ? metric.worst
            : counts                         ? 0
                                             : -HUGE_VAL,
            metric.better == Better::kLower ? metric.worst : HUGE_VAL};
  }

  /// Returns the kind of claims in which a measure is tested.
  const char* tested(const std::string& key) const {
    if (study_.hypotheses.empty())
      return std::ranges::find(compared_, key, &Metric::key) != compared_.end() ? "pairs" : "";
    return std::ranges::any_of(
               study_.hypotheses,
               [&](const Hypothesis& h) { return std::ranges::find(h.measures, key) != h.measures.end(); })
               ? "hypotheses"
               : "";
  }

  std::string description(const RunColumn& column) const {
    const auto& [key, title, unit, better, worst, meaning, digits] = column.metric;
    const bool is_number = column.type == std::string("number");
    const auto end = [&](double value) { return is_number && std::isfinite(value) ? csv_number(value) : ""; };
    const char* way = better == Better::kHigher ? "higher" : better == Better::kLower ? "lower" : "";
    return fmt::format("{},{},{},{},{},{},{},{},{},{}\n", csv_quoted(key), csv_quoted(title),
                       csv_quoted(meaning), csv_quoted(unit), column.type, end(column.range.low),
                       end(column.range.high), way, is_of_quads(key) ? "yes" : "", tested(key));
  }

  const StudyFile& study_;
  std::vector<Metric> compared_;
  std::vector<RunColumn> columns_;
};

}  // namespace

RunsCsv runs_csv(const StudyFile& study, const std::vector<CellRecord>& records) {
  return RunColumns(study, records).csv(records);
}

}  // namespace delquad
