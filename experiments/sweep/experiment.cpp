// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/experiment.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "base/located.h"
#include "experiments/sweep/adapt_loop.h"
#include "experiments/sweep/case_geometry.h"
#include "experiments/sweep/run_program.h"
#include "experiments/sweep/schema.h"
#include "io/cases/case_file.h"
#include "io/cases/problem_record.h"
#include "io/cases/read_problem.h"
#include "io/digest.h"
#include "metrics/metrics.h"
#include "metrics/solve/solver_metrics.h"
#include "metrics/tables/tables.h"

namespace delquad {
namespace {

/// Whether the text is one of the keys, up to a dot: commands may give several values.
bool is_known(const std::string& metric, const std::vector<std::string>& known) {
  return std::ranges::find(known, metric) != known.end() ||
         std::ranges::find(known, metric.substr(0, metric.find('.'))) != known.end();
}

void check_known(const TomlTable& table, const std::string& key, const std::string& metric,
                 const std::vector<std::string>& known) {
  if (is_known(metric, known)) return;
  throw InputError(table.where(key) + ": unknown metric '" + metric + "'" + suggestion(metric, known));
}

/// Keys that experiments had once, and the way to do the same now.
const TomlTable::RemovedKeys kRemovedKeys = {
    {"ratio", "runs.csv has both values: divide them there"},
    {"linf_delaunay", "'make paper' makes Figure 15 by experiments/paper/fig15_linf_delaunay.cpp"},
    {"slopes", "fit runs.csv, as experiments/studies/what_buys_error.py does"},
    {"correlate", "correlate columns of runs.csv, as experiments/studies/which_quality.py does"},
    {"repeat_times", "vary 'seed' in [matrix], and take the times from runs.csv"}};
const TomlTable::RemovedKeys kRemovedOfHypotheses = {
    {"secondary", "all hypotheses are one family: leave the others out, and pairs.* explores them"},
    {"two_sided", "every hypothesis is tested two-sided: remove the key"}};

/// Columns are measures and times.
void check_columns(const TomlTable& table, const std::vector<std::string>& columns,
                   std::vector<std::string> known) {
  known.emplace_back(kRuns);
  for (const Metric& one : columns_of_records()) known.push_back(one.key);
  for (const std::string& key : columns) {
    if (key == "finish_eta")
      refuse("{}: the column '{}' was removed: compare eta_mean of variants without finish steps",
             table.where("columns"), key);
    check_known(table, "columns", key, known);
  }
}

std::vector<PublishedRow> read_published(const std::filesystem::path& file,
                                         std::vector<std::string> columns) {
  const TomlTable top = TomlTable::read(file);
  top.require_known({{"source", ""}, {"row", ""}});
  const std::string source = top.text("source");
  for (const Metric& one : columns_of_records()) columns.push_back(one.key);
  std::vector<PublishedRow> rows;
  for (const TomlTable& table : top.tables("row")) {
    PublishedRow row{table.text("name"), source, {}};
    for (const std::string& key : table.keys()) {
      if (key == "name") continue;
      check_known(table, key, key, columns);
      row.values[key] = table.number(key);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

/// Returns the cases of an experiment; cases of another experiment come first.
std::vector<TomlTable> read_cases(const TomlTable& table) {
  std::vector<TomlTable> own = table.tables("case");
  if (!table.has("cases_of")) return own;
  const TomlTable other = TomlTable::read(table.file().parent_path() / table.text("cases_of"));
  other.require_known(experiment_keys());
  std::vector<TomlTable> cases = other.tables("case");
  if (cases.empty()) refuse("{}: {} has no cases", table.where("cases_of"), other.file().string());
  cases.insert(cases.end(), own.begin(), own.end());
  return cases;
}

std::string last_part(const std::string& key) { return key.substr(key.rfind('.') + 1); }

}  // namespace

std::vector<std::filesystem::path> Experiment::files() const {
  namespace fs = std::filesystem;
  std::set<fs::path> found;
  const auto add = [&](const fs::path& name) {
    std::error_code unknown;
    if (fs::is_regular_file(name, unknown)) found.insert(fs::absolute(name).lexically_normal());
  };
  add(file);
  for (const TomlTable& table : cases_) add(table.file());
  add(reference);
  for (const fs::path& peer_file : peer_files) add(peer_file);
  std::set<std::string> names;
  for (std::size_t i = 0; i < n_cases(); ++i) {
    const Case c = read_variant(i);
    names.insert(c.name);
    add(c.model_file);
    if (const auto size = size_file_of(c.size.text, c.size.folder)) add(size->path);
    if (const auto metric = size_file_of(c.metric.file, c.metric.folder)) add(metric->path);
    if (!c.may_be_absent) add(model_path(c));
  }
  // Programs of the system stay where they are.
  const auto add_beside = [&](const fs::path& folder, const std::string& pipeline) {
    if (!fs::path(pipeline).is_absolute()) add(folder / pipeline);
  };
  const auto add_files_of = [&](const Peer& peer, const std::vector<std::string>& command) {
    for (const auto& [pipeline, digest] : command_files(peer.folder, command))
      add_beside(peer.folder, pipeline);
  };
  for (const Peer& peer : peers) {
    add_files_of(peer, peer.version);
    for (const std::string& name : names) add_files_of(peer, command_of_case(peer, name));
  }
  for (const MetricCommand& metric : metrics)
    for (const auto& [pipeline, digest] : metric_files(metric)) add_beside(metric.folder, pipeline);
  return {found.begin(), found.end()};
}

std::size_t Experiment::n_variants() const {
  std::size_t n = 1;
  for (const Axis& axis : axes) n *= axis.values.size();
  return n;
}

void Experiment::read_matrix(const TomlTable& matrix) {
  matrix_ = matrix;
  leaves_ = matrix.leaves();
  constexpr double kMostCells = 1e7;
  double cells = 1;
  for (const std::string& leaf : leaves_) {
    Axis axis{leaf, last_part(leaf), {}};
    const auto same = [&](const std::string& other) { return last_part(other) == axis.title; };
    if (std::ranges::count_if(leaves_, same) > 1) axis.title = leaf;
    for (std::size_t i = 0; i < matrix.count(leaf); ++i) {
      axis.values.push_back(matrix.element_text(leaf, i));
      if (std::ranges::count(axis.values, axis.values.back()) > 1)
        throw InputError(matrix.where(leaf) + ": '" + leaf + "' has " + axis.values.back() + " twice");
    }
    cells *= static_cast<double>(axis.values.size());
    axes.push_back(std::move(axis));
  }
  for (const TomlTable& variant : variants_)
    for (const std::string& leaf : variant.leaves())
      if (std::ranges::count(leaves_, leaf) > 0)
        throw InputError(variant.where() + ": '" + leaf +
                         "' varies by [matrix] already: expected it in one of the two");
  if (cells > kMostCells)
    throw InputError(matrix.where() + ": more than 1e7 combinations: expected fewer values");
}

void Experiment::read_variants(const std::vector<TomlTable>& tables) {
  variants_ = tables;
  if (tables.empty()) return;
  Axis axis{"", "variant", {}};
  for (const TomlTable& table : tables) {
    axis.values.push_back(table.text("name"));
    if (std::ranges::count(axis.values, axis.values.back()) > 1)
      throw InputError(table.where("name") + ": a second variant '" + axis.values.back() +
                       "': expected another name");
    table.require_known(variant_keys());
  }
  axes.push_back(std::move(axis));
}

Case Experiment::read_variant(std::size_t index_of_case, std::size_t variant) const {
  std::vector<std::size_t> choice(axes.size());
  for (std::size_t k = axes.size(); k-- > 0; variant /= axes[k].values.size())
    choice[k] = variant % axes[k].values.size();
  const TomlTable& plain = cases_[index_of_case];
  TomlTable table = plain;
  if (!variants_.empty()) {
    std::vector<std::string> leaves = variants_[choice[0]].leaves();
    std::erase(leaves, "name");
    table = table.with_choice(variants_[choice[0]], leaves, std::vector(leaves.size(), TomlTable::kWhole));
  }
  if (matrix_)
    table =
        table.with_choice(*matrix_, leaves_, {choice.begin() + (variants_.empty() ? 0 : 1), choice.end()});
  table.require_known(experiment_case_keys());
  Case c = defaults_;
  c.name = table.text("name");
  c.where = table.where();
  c.folder = c.name;
  read_case_keys(table, c);
  read_study_keys(table, c);
  check_comparisons(table, c);
  if (!has_model(c))
    throw InputError(table.where() + ": case '" + c.name +
                     "' has no model: expected 'loop', 'pattern', 'mesh', 'model', 'data' or 'example'");
  c.max_elements = max_elements;
  c.allow_unsound = true;  // who runs it decides
  for (std::size_t k = 0; k < axes.size(); ++k) {
    c.variant.emplace_back(axes[k].title, axes[k].values[choice[k]]);
    c.folder += (k == 0 ? "@" : ",") + axes[k].title + "=" + folder_text(axes[k].values, choice[k]);
  }
  return c;
}

void Experiment::check_comparisons(const TomlTable& table, const Case& c) const {
  std::vector<std::string> names;
  for (const PublishedRow& row : published) names.push_back(row.name);
  for (const auto& [pipeline, name] : c.compare) {
    located(table.where("compare"), [&] { find_pipeline(pipeline); });
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    throw InputError(table.where("compare") + ": no published row '" + name + "'" + suggestion(name, names));
  }
}

const Peer* Experiment::peer_of(const Pipeline& pipeline) const {
  if (!pipeline.stages.empty()) return nullptr;
  return &*std::ranges::find(peers, pipeline.text, &Peer::name);
}

Pipeline Experiment::find_pipeline(const std::string& text) const {
  const bool is_peer = std::ranges::find(peers, text, &Peer::name) != peers.end();
  if (is_peer) return {text, {}, PatchForm::kQuads};
  std::vector<std::string> names;
  for (const Peer& peer : peers) names.push_back(peer.name);
  try {
    return parse_pipeline(text, start_);
  } catch (const InputError& error) {
    const std::string what = error.what() + suggestion(text, names);
    throw InputError(what + (what.find("did you mean") != std::string::npos
                                 ? ""
                                 : "; another mesher needs its file (--peer FILE)"));
  }
}

std::vector<Pipeline> Experiment::find_pipelines(const std::vector<std::string>& texts) const {
  if (texts.empty()) throw InputError("no pipeline given: expected pipelines such as DB");
  std::vector<Pipeline> found;
  for (const std::string& text : texts) {
    if (std::ranges::find(found, text, &Pipeline::text) != found.end())
      throw InputError("pipeline '" + text + "' is given twice: expected it once");
    found.push_back(find_pipeline(text));
  }
  return found;
}

Experiment Experiment::read(const std::filesystem::path& file, const std::filesystem::path& data,
                            bool with_pipelines) {
  const TomlTable table = TomlTable::read(file);
  table.refuse_removed(kRemovedKeys);
  for (const TomlTable& one : table.tables("hypotheses")) one.refuse_removed(kRemovedOfHypotheses);
  table.require_known(experiment_keys());
  Experiment experiment;
  experiment.table_ = table;
  experiment.file = file;
  experiment.cases_ = read_cases(table);
  if (table.has("start") ||
      std::ranges::any_of(experiment.cases_, [](const auto& c) { return c.has("start"); }))
    experiment.start_ = PipelineStart::kGivenMesh;
  experiment.title = file.stem().string();
  read_fields(table, static_cast<TablePlan&>(experiment));
  read_fields(table, static_cast<ExperimentKeys&>(experiment));
  experiment.settle_calibration(table);
  if (with_pipelines)
    experiment.parsed =
        located(table.where("pipelines"), [&] { return experiment.find_pipelines(experiment.pipelines); });
  experiment.check_metrics(table);
  const std::vector<std::string> metrics = experiment.keys_of_metrics();
  if (!experiment.reference.empty()) experiment.published = read_published(experiment.reference, metrics);
  check_columns(table, experiment.columns, metrics);
  experiment.read_variants(table.tables("variant"));
  if (const auto matrix = table.optional_table("matrix")) experiment.read_matrix(*matrix);
  experiment.hypothesis_tables_ = table.tables("hypotheses");
  experiment.check_plan(table);

  experiment.defaults_.where = file.string();
  experiment.defaults_.data_folder = data;
  read_case_keys(table, experiment.defaults_);
  read_study_keys(table, experiment.defaults_);
  if (experiment.cases_.empty())
    refuse(
        "{}: no cases: expected [[case]] tables; a model by itself goes to 'delquad mesh' "
        "[experiment-or-model]",
        file.string());
  std::vector<std::string> names;
  for (std::size_t i = 0; i < experiment.n_cases(); ++i) {
    const std::string name = experiment.cases_[i].text("name");
    check_folder_name(experiment.cases_[i], name, names);
    names.push_back(name);
    for (std::size_t v = 0; v < experiment.n_variants(); ++v) {
      const Case c = experiment.read_variant(i, v);
      check_case(c);
      check_adapt(c);
      for (const Pipeline& pipeline : experiment.parsed)
        if (!pipeline.stages.empty())
          located(c.where, [&] { parse_pipeline(pipeline.text, pipeline_start(c.model)); });
    }
  }
  return experiment;
}

std::string Experiment::plan(const StudyFile& study) const {
  RecordJson plan = record_of<TablePlan>(*this);
  plan.update(record_of<ExperimentKeys>(*this));
  std::vector<std::string> parts;  // whose order does not count
  const auto add = [&](const RecordJson& part) {
    parts.push_back(part.dump(-1, ' ', false, RecordJson::error_handler_t::replace));
  };
  for (const RecordJson& hypothesis : plan["hypotheses"]) add(hypothesis);
  plan.erase("hypotheses");
  add(study.problems);
  for (const auto& [name, geometry] : study.geometry) {
    add({name, geometry.domain});
    for (const Peer& peer : peers) add(command_files(peer.folder, command_of_case(peer, name)));
  }
  for (const Pipeline& pipeline : parsed) add(pipeline.text);
  for (const MetricCommand& metric : metrics) add(metric_files(metric));
  std::ranges::sort(parts);
  add(plan);
  return digest(fmt::format("{}", fmt::join(parts, "\n")));
}

StudyFile describe(const Experiment& experiment) {
  StudyFile study;
  static_cast<TablePlan&>(study) = experiment;
  study.experiment = experiment.file.stem().string();
  for (const Pipeline& pipeline : experiment.parsed) study.pipelines.push_back(pipeline.text);
  for (const Axis& axis : experiment.axes) study.axes.emplace_back(axis.title, axis.values);
  study.cells = experiment.n_cells();
  for (std::size_t i = 0; i < experiment.n_cases(); ++i) {
    const Case c = experiment.read_variant(i);
    study.cases.push_back(c.name);
    study.geometry[c.name] = geometry_of(c);
    if (!c.compare.empty()) study.compare[c.name] = c.compare;
    for (std::size_t v = 0; v < experiment.n_variants(); ++v) {
      const Case variant = experiment.read_variant(i, v);
      study.problems[variant.folder] = {record_of(variant).digest()};
    }
  }
  study.plan = experiment.plan(study);
  return study;
}

}  // namespace delquad
