#include "pipeline/experiment_runner.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <ostream>
#include <system_error>

#include "io/mesh_io.h"
#include "io/picture.h"
#include "mesh/error.h"
#include "pipeline/case_pictures.h"
#include "pipeline/cell_folder.h"
#include "pipeline/interrupt.h"
#include "pipeline/linf_study.h"
#include "pipeline/record.h"
#include "pipeline/runner.h"
#include "pipeline/stopwatch.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSeconds = "seconds";
/// What the paper's tables show, then the counts and the time.
const std::vector<std::pair<const char*, int>> kColumns = {
    {"n_vertices", 0}, {"n_quads", 0}, {"n_triangles", 0}, {"eta_worst", 3}, {"eta_mean", 3},
    {"d4", 1},         {"d_min", 0},   {"d_max", 0},       {"tau", 1},       {"percent_quads", 1}};

/// With a column for each step's time, or one for the stages of the pipeline.
std::vector<TableColumn> table_columns(bool step_times) {
  std::vector<TableColumn> columns;
  for (const auto& [key, digits] : kColumns) {
    const auto metrics = metric_registry();
    const auto at =
        std::find_if(metrics.begin(), metrics.end(), [&](const Metric& m) { return m.key == key; });
    columns.push_back({key, at == metrics.end() ? key : at->title, digits});
  }
  if (!step_times) {
    columns.push_back({kSeconds, "s", 2});
    return columns;
  }
  for (const StepTime& step : step_times_of_tables()) columns.push_back({step.key, step.title, 2});
  return columns;
}

/// Seconds by column, of the steps that the cells of a case share and of the pipeline's own.
void add_step_times(const PreparedCase& prepared, const RunResult& result, TableRow& row) {
  double total = 0;
  for (const StepTime& time : step_times_of_tables()) {
    for (const auto* seconds : {&prepared.seconds, &result.log.seconds})
      for (const auto& [step, s] : *seconds)
        if (step == time.step) {
          row.values[time.key] += s;
          total += s;
        }
    if (*time.step == 0) row.values[time.key] = total;
  }
}

void write_text(const fs::path& path, const std::string& text) {
  write_file_atomically(path, [&](std::ostream& out) { out << text; });
}

class Runner {
 public:
  Runner(const Experiment& experiment, const fs::path& folder, Progress& progress)
      : experiment_(experiment), folder_(folder), progress_(progress) {
    outcome_.table.title = experiment.title;
    outcome_.table.columns = table_columns(experiment.step_times);
  }

  ExperimentOutcome run() {
    for (const PublishedRow& row : experiment_.published)
      outcome_.table.rows.push_back({"published", row.name, row.values, {}, row.source, ""});
    for (const Case& c : experiment_.cases) run_case(c);
    if (experiment_.ratio) note_ratio(*experiment_.ratio);
    return std::move(outcome_);
  }

 private:
  /// Whether the case is left out because its data is not there.
  bool skip_case(const Case& c) {
    if (!c.may_be_absent || fs::exists(model_path(c))) return false;
    const std::string reason = "data not found, skipped: " + model_path(c).string();
    progress_.message(c.name + ": " + reason);
    outcome_.table.notes.push_back(c.name + ": " + reason);
    progress_.skip(1);
    for (const Word& word : experiment_.words) {
      progress_.skip(run_steps(word));
      outcome_.table.rows.push_back({c.name, word.text, {}, {}, "", "", "data not found"});
      write_reason(c, word, "skipped", reason);
    }
    return true;
  }

  void run_case(const Case& c) {
    if (skip_case(c)) return;
    progress_.step(c.name + ": boundary and fields");
    std::optional<PreparedCase> prepared;
    const std::string failure = guarded(c.name, [&] { prepared = prepare_case(c); });
    if (prepared) {
      if (as_number(c.size.base) && c.size.sources.empty())
        outcome_.table.notes.push_back(fmt::format("{}: uniform delta = {}", c.name, c.size.base));
      for (const std::string& warning : prepared->warnings) progress_.message("warning: " + warning);
      const std::string undrawn = guarded(c.name, [&] {
        const fs::path folder = folder_ / c.name;
        prepare_folder(folder);
        const Uninterrupted whole;
        draw_case(*prepared, c.name, folder);
      });
      if (!undrawn.empty())
        outcome_.table.notes.push_back(c.name + ": no pictures of its fields: " + undrawn);
    }
    for (const Word& word : experiment_.words) {
      if (prepared)
        run_cell(c, *prepared, word);
      else {
        progress_.skip(run_steps(word));
        add_failure(c, word, failure);
      }
    }
  }

  void run_cell(const Case& c, const PreparedCase& prepared, const Word& word) {
    const std::string label = c.name + " " + word.text;
    std::optional<RunResult> result;
    const std::string failure = guarded(label, [&] {
      result = run_word(c, prepared, word, progress_);
      write_cell(folder_ / c.name / word.text, [&](const fs::path& folder) {
        const Stopwatch writing;
        write_msh(folder / "mesh.msh", result->mesh);
        write_vtu(folder / "mesh.vtu", result->mesh, {{"eta", cell_etas(result->mesh)}});
        (prepared.background ? draw_mesh : draw_surface)(folder / "picture.svg", result->mesh, label);
        if (!result->log.smoothing.empty())
          draw_convergence(folder / "convergence.svg", result->log.smoothing, label + ": smoothing");
        result->log.add_seconds("write", writing.work_seconds());
        write_text(folder / "record.json", run_record(c, prepared, word, *result));
      });
    });
    if (!failure.empty()) return add_failure(c, word, failure);
    for (const std::string& warning : result->warnings) outcome_.table.notes.push_back("warning: " + warning);
    TableRow row{c.name, word.text, result->metrics.values, {}, "", ""};
    if (experiment_.step_times)
      add_step_times(prepared, *result, row);
    else
      row.values[kSeconds] = result->seconds;
    compare(c, word, row);
    outcome_.table.rows.push_back(std::move(row));
    if (word.result == PatchForm::kQuads)
      outcome_.leftover_triangles += static_cast<long long>(result->mesh.triangles.size());
  }

  void compare(const Case& c, const Word& word, TableRow& row) const {
    const auto name = c.compare.find(word.text);
    if (name == c.compare.end()) return;
    for (const PublishedRow& published : experiment_.published)
      if (published.name == name->second) {
        row.published = published.values;
        row.source = published.name + ", " + published.source;
      }
  }

  void add_failure(const Case& c, const Word& word, const std::string& reason) {
    outcome_.table.rows.push_back({c.name, word.text, {}, {}, "", reason});
    write_reason(c, word, "failed", reason);
  }

  void write_reason(const Case& c, const Word& word, const std::string& status, const std::string& reason) {
    try {
      write_cell(folder_ / c.name / word.text, [&](const fs::path& folder) {
        write_text(folder / "record.json", failure_record(c, word, status, reason));
      });
    } catch (const InputError& error) {  // there is no result; the table says why
      progress_.message(fmt::format("error: {} {}: {}", c.name, word.text, error.what()));
    }
  }

  /// Runs `work`, called `label`; returns why it failed, empty when it did not. Counts the failure and prints
  /// it.
  template <class F>
  std::string guarded(const std::string& label, F&& work) {
    std::string reason;
    try {
      work();
    } catch (const InputError& error) {
      reason = error.what();
      ++outcome_.bad_inputs;
      progress_.message(fmt::format("error: {}: {}", label, reason));
    } catch (const std::exception& error) {
      reason = std::string("internal error: ") + error.what();
      ++outcome_.internal_errors;
      progress_.message(fmt::format("{}: {}", label, reason));
    }
    return reason;
  }

  void note_ratio(const ExpectedRatio& ratio) {
    for (const Case& c : experiment_.cases) {
      const double a = value(c.name, ratio.numerator, ratio.metric),
                   b = value(c.name, ratio.denominator, ratio.metric);
      if (std::isnan(a) || std::isnan(b) || b == 0) continue;
      outcome_.table.notes.push_back(
          fmt::format("{}: {} of {} / {} = {:.4f}; expected {:.4f} ({:+.2f} %{}{})", c.name, ratio.metric,
                      ratio.numerator, ratio.denominator, a / b, ratio.expected,
                      100 * (a / b / ratio.expected - 1), ratio.source.empty() ? "" : "; ", ratio.source));
    }
  }

  double value(const std::string& case_name, const std::string& word, const std::string& metric) const {
    for (const TableRow& row : outcome_.table.rows)
      if (row.group == case_name && row.name == word && row.values.contains(metric))
        return row.values.at(metric);
    return std::nan("");
  }

  const Experiment& experiment_;
  const fs::path& folder_;
  Progress& progress_;
  ExperimentOutcome outcome_;
};

/// Each table that can be written; the others count as failures.
void write_tables(const fs::path& folder, Progress& progress, ExperimentOutcome& outcome) {
  using Printer = std::string (*)(const Table&);
  constexpr Printer kPrinters[] = {to_markdown, to_csv, to_tex, to_json};  // as in table_files()
  const Uninterrupted whole;
  for (std::size_t i = 0; i < std::size(kPrinters); ++i) {
    try {
      write_text(folder / table_files()[i], kPrinters[i](outcome.table));
    } catch (const InputError& error) {
      ++outcome.bad_inputs;
      progress.message(fmt::format("error: {}", error.what()));
    }
  }
}

}  // namespace

int experiment_steps(const Experiment& experiment) {
  if (experiment.linf) return linf_study_steps(*experiment.linf);
  int steps = 0;
  for (const Word& word : experiment.words) steps += run_steps(word);
  return static_cast<int>(experiment.cases.size()) * (1 + steps);
}

ExperimentOutcome run_experiment(const Experiment& experiment, const fs::path& folder, Progress& progress) {
  prepare_folder(folder);
  ExperimentOutcome outcome;
  if (experiment.linf) {
    outcome.table = run_linf_study(*experiment.linf, experiment.title, folder, progress);
    for (const TableRow& row : outcome.table.rows) outcome.bad_inputs += row.failure.empty() ? 0 : 1;
  } else {
    outcome = Runner(experiment, folder, progress).run();
  }
  write_tables(folder, progress, outcome);
  return outcome;
}

void prepare_folder(const fs::path& folder) {
  std::error_code status;
  fs::create_directories(folder, status);
  if (!fs::is_directory(folder))
    throw InputError(fmt::format("{}: the folder cannot be made: {}", folder.string(), status.message()));
  std::string probe = (folder / ".delquad-XXXXXX").string();
  const int file = mkstemp(probe.data());
  if (file < 0)
    throw InputError(fmt::format("{}: the folder cannot be written to: {}", folder.string(),
                                 std::generic_category().message(errno)));
  close(file);
  fs::remove(probe, status);
}

}  // namespace delquad
