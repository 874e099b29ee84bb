// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/tables/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <system_error>

#include "base/located.h"
#include "base/text.h"
#include "delquad/error.h"
#include "io/mesh_io.h"
#include "metrics/tables/inference.h"
#include "metrics/tables/notes.h"
#include "metrics/tables/runs.h"
#include "metrics/tables/statistics.h"
#include "metrics/tables/summary.h"

namespace delquad {

/// Entries of docs/bibliography.bib that captions of tables and figures cite.
extern const char* const kBibliography;

namespace {

namespace fs = std::filesystem;

CellAddress address_of(const CellRecord& record) { return {record.name, record.variant, record.pipeline}; }

constexpr const char *kRunsFile = "runs.csv", *kRunColumns = "runs_columns.csv", *kPrinted = "tables.tex",
                     *kReferences = "references.bib";

class Tabulation {
 public:
  Tabulation(const StudyFile& study, const std::vector<CellRecord>& records)
      : study_(study), records_(records), inference_(study, records) {}

  Outcome run() {
    Table& table = outcome_.table;
    table.title = study_.title;
    table.columns = table_columns(study_, records_);
    if (!study_.columns.empty()) table.shown = {kRuns};
    for (const std::string& key : study_.columns)
      if (key != kRuns) table.shown.push_back(key);
    for (const PublishedRow& row : study_.published)
      table.rows.push_back({"published", row.name, row.values, {}, row.source, ""});
    for (const Samples& row : group_samples(records_)) add_row(row);
    add_notes(triangle_notes(records_, "measures of quads (eta, d4 and the like) leave these triangles out"),
              table);
    add_notes(quad_count_notes(records_), table);
    note_cells();
    note_failed_metrics();
    note_may_fail();
    outcome_.pairs = pairs_table(study_.title, inference_);
    outcome_.hypotheses = hypotheses_table(study_.title, inference_);
    outcome_.summary = summarise(study_, records_, inference_);
    print();
    add_late_note(is_planned() ? outcome_.hypotheses : outcome_.pairs);
    add_late_note(outcome_.summary);
    for (Table* one : {&outcome_.pairs, &outcome_.hypotheses, &outcome_.summary})
      if (one == &outcome_.pairs || !one->rows.empty()) note_pairs(*one);
    return std::move(outcome_);
  }

 private:
  bool is_planned() const { return !study_.hypotheses.empty(); }

  /// Returns a note that questions asked after the runs are no claims.
  std::string late_note() const {
    return !study_.plan_changed ? ""
           : is_planned()       ? kNotPlanned
                          : "Not planned: this study had hypotheses, which were taken out after the first "
                            "mesh was made.";
  }
  void add_late_note(Table& table) const {
    if (study_.plan_changed) table.notes.insert(table.notes.begin(), late_note());
  }

  void add_row(const Samples& samples) {
    TableRow row{samples.group, samples.pipeline, {}, {}, "", ""};
    for (const CellRecord* failed : samples.failed) {
      if (may_fail(study_, address_of(*failed))) continue;
      ++(failed->kind == "bad input" ? outcome_.bad_inputs
         : failed->kind == "unsound" ? outcome_.unsound
                                     : outcome_.others_failed);
      outcome_.failures[failed->reason].push_back(failed->group + " " + failed->pipeline);
    }
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
        row.incomplete = fmt::format("{} of {} failed", samples.failed.size(),
                                     samples.failed.size() + samples.done.size());
      if (!samples.failed.empty())
        outcome_.table.notes.push_back(fmt::format(
            "{} {}: {} of {} runs failed, the first: {}", samples.group, samples.pipeline,
            samples.failed.size(), samples.failed.size() + samples.done.size(), samples.failed[0]->reason));
      if (samples.done[0]->quads_only)
        for (const double n : samples.of("n_triangles"))
          outcome_.leftover_triangles += static_cast<long long>(n);
    }
    row.values[kRuns] = static_cast<double>(samples.done.size());
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

  static void add_notes(const std::vector<std::string>& notes, Table& table) {
    table.notes.insert(table.notes.end(), notes.begin(), notes.end());
  }

  /// Adds notes on missing pairs.
  void note_pairs(Table& table) const {
    add_notes(triangle_notes(records_,
                             "no pair with it is compared in measures of quads (eta, d4 and the like), from "
                             "which the triangles are missing"),
              table);
    add_notes(quadless_notes(records_), table);
    add_notes(quad_count_notes(records_), table);
  }

  /// Prints summary and pairs in few columns, with captions.
  void print() {
    Table summary = outcome_.summary, pairs = is_planned() ? outcome_.hypotheses : outcome_.pairs;
    if (summary.rows.empty()) return;
    const std::string tests =
        "Wilcoxon's signed-rank test over domains~\\cite{wilcoxon1945}, two-sided, corrected by Holm's "
        "method~\\cite{holm1979} over all " +
        std::string(is_planned() ? "hypotheses" : "tests of the study") +
        " that could prove a difference~\\cite{tarone1990}";
    const std::string interval =
        "with its 95\\,\\% interval by Student's statistic without its "
        "skewness~\\cite{hall1992}, over domains";
    const std::string late = study_.plan_changed ? "\\textbf{" + late_note() + "} " : "";
    const auto bold = [&](const char* what) {
      return study_.plan_changed ? "" : fmt::format(" Bold: proven at 5\\,\\%{}.", what);
    };
    summary.notes.clear();
    if (!is_planned()) summary.notes.push_back(inference_.family().note());
    note_pairs(summary);
    std::string text =
        to_tex_floats(summary, "tab:summary",
                      late + "Mean over domains " + interval +
                          ". Won, lost: on how many domains one is better, or worse, than every other" +
                          (summary.name_title == "pipeline" ? "" : " of its axis") +
                          "; who failed is worse. Proven better than: " +
                          (is_planned() ? "as hypotheses ask, by " : "by ") + tests + "." +
                          bold(" to be better than all others, without a failure"));
    const bool fails = std::ranges::find(pairs.shown, "first_failed") != pairs.shown.end();
    pairs.columns = {{"domains", "domains", 0},
                     {"won_lost", "won/lost", 0},
                     {"effect", "difference", 4},
                     {"p_corrected", "p corr.", 4},
                     {"first_is", is_planned() ? "verdict" : "first is", 0}};
    if (fails) pairs.columns.insert(pairs.columns.begin() + 2, {"failed", "failed", 0});
    pairs.shown.clear();
    std::erase_if(pairs.notes, [](const std::string& note) { return !note.ends_with(": left out"); });
    for (TableRow& row : pairs.rows) {
      row.texts["won_lost"] = fmt::format("{}/{}", row.values.at("better"), row.values.at("worse"));
      row.texts["failed"] =
          fmt::format("{}/{}", row.values.at("first_failed"), row.values.at("second_failed"));
    }
    text += to_tex_floats(
        pairs, "tab:pairs",
        late + "Won/lost: on how many domains the first is better and worse" +
            (fails ? "; failed: on how many the first and the second did, and lost there" : "") +
            ". Difference: first minus second, mean over domains " + interval + ". p corr.: of " + tests +
            "." + bold(fails ? ", without a failure" : ""));
    outcome_.files[kPrinted] = "% To be input with booktabs; references.bib has what is cited.\n" + text;
    outcome_.files[kReferences] = kBibliography;
  }

  /// Adds notes on single cells and on missing ones.
  void note_cells() {
    std::vector<std::string>& notes = outcome_.table.notes;
    std::set<std::string> said;
    const auto add_line = [&](const std::string& text) {
      if (said.insert(text).second) notes.push_back(text);
    };
    note_uniform_sizes();
    for (const CellRecord& record : records_) {
      if (domain_of(record) != record.name)
        add_line(fmt::format("{} is the domain {}, and counts with it", record.name, record.domain));
      if (record.kind == kNotApplicable)
        outcome_.inapplicable[record.reason].push_back(record.group + " " + record.pipeline);
      else if (record.skipped)
        add_line(fmt::format("{}: {}", record.name, record.reason));
      note_size(record, add_line);
      for (const std::string& reason : record.unsound)
        add_line(fmt::format("{} {} is not sound: {}", record.group, record.pipeline, reason));
      for (const std::string& warning : record.warnings)
        if (warning.starts_with(record.name + " ")) add_line("warning: " + warning);
    }
    for (const std::string& note : inapplicable_notes(outcome_)) add_line(note);
    for (const std::string& note : calibration_notes(records_)) add_line(note);
    if (records_.size() < study_.cells)
      notes.push_back(
          fmt::format("{} of {} cells have no result yet", study_.cells - records_.size(), study_.cells));
  }

  /// Adds a note for each measure with missing values: where, and why.
  void note_failed_metrics() {
    std::map<std::string, std::pair<std::size_t, std::string>> failed;  // number, and the first
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

  static bool is_uniform(const CellRecord& record) {
    return !record.uniform_size.empty() && record.variant.empty();
  }

  /// Says which cases have a uniform size, a line for each size.
  void note_uniform_sizes() {
    constexpr std::size_t kMostNames = 8;
    std::map<std::string, std::vector<std::string>> cases;
    for (const CellRecord& record : records_) {
      if (!is_uniform(record) || !record.size_adapted_to.empty()) continue;
      auto& names = cases[record.uniform_size];
      if (std::ranges::find(names, record.name) == names.end()) names.push_back(record.name);
    }
    for (const auto& [size, names] : cases)
      outcome_.table.notes.push_back(
          fmt::format("{}: uniform delta = {}", first_of(names, kMostNames), size));
  }

  /// Says against which size tau is measured, if not against the given one.
  template <class AddLine>
  static void note_size(const CellRecord& record, const AddLine& add_line) {
    if (record.size_adapted_to.empty()) return;
    add_line(
        fmt::format("{}: delta{} was made smaller for {}: tau is measured against that, tau given against "
                    "delta as it was given",
                    record.name, is_uniform(record) ? " = " + record.uniform_size : "",
                    fmt::join(record.size_adapted_to, " and ")));
  }

  /// Adds notes with the number of failed cells among the cells that may fail.
  void note_may_fail() {
    for (const MayFail& cells : study_.may_fail) {
      std::size_t all = 0, failed = 0;
      for (const CellRecord& record : records_) {
        if (record.skipped || !is_one_of(cells, address_of(record))) continue;
        ++all;
        failed += record.reason.empty() ? 0 : 1;
      }
      if (all == 0) continue;
      std::vector<std::string> which;
      if (!cells.name.empty()) which.push_back("case " + cells.name);
      if (!cells.variant.empty()) which.push_back("variant " + cells.variant);
      if (!cells.pipeline.empty()) which.push_back("pipeline " + cells.pipeline);
      outcome_.table.notes.push_back(fmt::format("{}: declared in `may_fail`; {} of {} cells failed",
                                                 fmt::join(which, ", "), failed, all));
    }
  }

  const StudyFile& study_;
  const std::vector<CellRecord>& records_;
  Inference inference_;
  Outcome outcome_;
};

}  // namespace

std::vector<std::string> inapplicable_notes(const Outcome& outcome) {
  std::vector<std::string> notes;
  for (const auto& [reason, cells] : outcome.inapplicable)
    notes.push_back(cells.size() == 1 ? fmt::format("{} is not applicable: {}", cells[0], reason)
                                      : fmt::format("{} and {} more are not applicable: {}", cells[0],
                                                    counted(cells.size() - 1, "cell"), reason));
  return notes;
}

StudyResults read_results(const fs::path& folder) {
  StudyResults results;
  results.records = read_records(folder);
  std::optional<StudyFile> study = read_study(folder);
  if (!study)
    refuse("{}: is missing: expected a folder of 'delquad run -o'", (folder / "study.json").string());
  results.study = *std::move(study);
  results.left_out = std::erase_if(
      results.records, [&](const CellRecord& r) { return !place_of(results.study, address_of(r)); });
  return results;
}

Outcome make_tables(const StudyResults& results) {
  Outcome outcome = Tabulation(results.study, results.records).run();
  const RunsCsv runs = runs_csv(results.study, results.records);
  outcome.files[kRunsFile] = runs.lines;
  outcome.files[kRunColumns] = runs.columns;
  for (const CellRecord& record : results.records) {
    if (!record.metric_failed) continue;
    ++outcome.metrics_failed;
    outcome.failures["a measure by command failed"].push_back(record.group + " " + record.pipeline);
  }
  if (results.left_out > 0)
    outcome.table.notes.push_back(
        fmt::format("{} records of cells that the experiment no longer has are left out", results.left_out));
  return outcome;
}

Outcome make_tables(const fs::path& folder) { return make_tables(read_results(folder)); }

namespace {

/// A table of the outcome, with its name and formats.
struct WrittenTable {
  const char* name;
  const Table Outcome::*table;
  bool in_all_formats;
};
const WrittenTable kTables[] = {{"table", &Outcome::table, true},
                                {"pairs", &Outcome::pairs, false},
                                {"hypotheses", &Outcome::hypotheses, false},
                                {"summary", &Outcome::summary, false}};

/// Returns the texts by name; missing files are empty.
std::map<std::string, std::string> texts_of(const Outcome& outcome) {
  std::map<std::string, std::string> files = {
      {kRunsFile, ""}, {kRunColumns, ""}, {kPrinted, ""}, {kReferences, ""}};
  for (const auto& [name, text] : outcome.files) files[name] = text;
  for (const auto& [name, table, in_all] : kTables)
    for (const TableFormat& format : table_formats()) {
      const std::string extension = format.extension;
      const bool is_written = in_all || extension == ".md" || extension == ".csv";
      files[name + extension] =
          is_written && !(outcome.*table).rows.empty() ? format.print(outcome.*table) : "";
    }
  return files;
}

}  // namespace

std::vector<std::string> write_tables(const fs::path& folder, const Outcome& outcome) {
  std::vector<std::string> errors;
  std::error_code kept;  // in a folder without write access, as the errors then say
  for (const auto& [name, text] : texts_of(outcome)) try {
      // An old file that this run does not request would be taken for its own.
      text.empty() ? void(fs::remove(folder / name, kept)) : write_text_file(folder / name, text);
    } catch (const InputError& error) {
      errors.push_back(error.what());
    }
  return errors;
}

std::vector<std::string> result_files() {
  std::vector<std::string> files = {"study.json", "experiment", kFigures};
  for (const auto& [name, text] : texts_of({})) files.push_back(name);
  return files;
}

}  // namespace delquad
