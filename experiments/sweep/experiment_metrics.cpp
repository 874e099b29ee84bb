#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <limits>

#include "delquad/error.h"
#include "experiments/sweep/experiment.h"
#include "experiments/sweep/experiment_keys.h"
#include "experiments/sweep/schema.h"
#include "metrics/metrics.h"
#include "metrics/solve/solver_metrics.h"
#include "metrics/tables/table.h"

/// The measures of an experiment.
namespace delquad {
namespace {

Better read_better(const TomlTable& table) {
  const std::string text = table.text("better", "neither");
  if (text == "higher") return Better::kHigher;
  if (text == "lower") return Better::kLower;
  if (text == "neither") return Better::kNeither;
  throw InputError(table.where("better") + ": 'better' is '" + text +
                   "': expected \"higher\", \"lower\" or \"neither\"");
}

}  // namespace

std::vector<std::string> Experiment::keys_of_metrics() const {
  std::vector<std::string> keys;
  for (const Metric& m : metric_registry()) keys.push_back(m.key);
  for (const std::string& solver : solvers)
    for (const Metric& m : metrics_of_solver(solver)) keys.push_back(m.key);
  for (const MetricCommand& command : metrics) keys.push_back(command.metric.key);
  return keys;
}

void Experiment::read_metric(const TomlTable& table) {
  MetricCommand command;
  Metric& metric = command.metric;
  metric.key = table.text("name");
  command.folder = file.parent_path();
  const auto plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
  if (metric.key.empty() || metric.key.size() > 60 ||
      std::isalpha(static_cast<unsigned char>(metric.key[0])) == 0 || !std::ranges::all_of(metric.key, plain))
    throw InputError(table.where("name") + ": '" + metric.key +
                     "': the name of a metric is a letter, then letters, digits, '_' and '-'");
  std::vector<std::string> taken = keys_of_metrics();
  for (const StepTime& time : step_times_of_tables()) taken.push_back(time.key);
  for (const char* key : {"seconds", kRowEnds, kFinishSeconds, kFinishEta}) taken.emplace_back(key);
  if (std::ranges::find(taken, metric.key) != taken.end())
    throw InputError(table.where("name") + ": there is a metric '" + metric.key + "' already");
  command.command = read_command(table, "command");
  check_placeholders(table, command.command, metric_placeholders(), {{"{mesh}", "{folder}"}});
  if (table.has("files")) command.files = table.texts("files");
  for (const std::string& name : command.files)
    if (!std::filesystem::is_regular_file(command.folder / name))
      throw InputError(table.where("files") + ": no file '" + (command.folder / name).string() + "'");
  metric.title = table.text("title", metric.key);
  metric.unit = table.text("unit", "");
  metric.better = read_better(table);
  metric.worst = std::numeric_limits<double>::quiet_NaN();
  metric.source = fmt::format("{}", fmt::join(command.command, " "));
  metric.digits = read_count(table, "digits", 0, kMostDigits, metric.digits);
  command.timeout = static_cast<unsigned>(read_count(table, "timeout", 1, kMostSeconds, 0));
  table.finish(metric_keys());
  metrics.push_back(std::move(command));
}

}  // namespace delquad
