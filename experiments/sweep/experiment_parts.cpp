// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

#include "base/located.h"
#include "base/nearest_name.h"
#include "delquad/error.h"
#include "experiments/sweep/experiment.h"
#include "experiments/sweep/schema.h"
#include "metrics/anisotropic_measures.h"
#include "metrics/judgement/criteria.h"
#include "metrics/solve/solver_metrics.h"
#include "metrics/tables/samples.h"
#include "metrics/tables/tables.h"

// The measures and the peers of an experiment.

namespace delquad {

namespace {

std::string lower_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

/// Returns the placeholders, such as "{input}", but not "${input}", which belongs to the shell.
std::vector<std::string> names_in_braces(const std::string& word) {
  std::vector<std::string> names;
  const auto is_letter = [](unsigned char c) { return std::isalpha(c) != 0 || c == '_'; };
  for (std::size_t at = 0; (at = word.find('{', at)) != std::string::npos; ++at) {
    const auto end = word.find('}', at);
    if (end == std::string::npos || end == at + 1 || (at > 0 && word[at - 1] == '$')) continue;
    const std::string name = word.substr(at, end + 1 - at);
    if (std::all_of(name.begin() + 1, name.end() - 1, is_letter)) names.push_back(name);
  }
  return names;
}

bool is_program_text(const std::string& word) {
  return word.find_first_of(" \t\n\"'$;(") != std::string::npos;
}

}  // namespace

void check_placeholders(const TomlTable& table, const std::vector<std::string>& command,
                        const std::vector<std::string>& known,
                        const std::vector<std::vector<std::string>>& needed) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(table.where("command") + ": 'command' " + what);
  };
  std::vector<std::string> strange;
  for (const std::string& word : command)
    for (const std::string& name : names_in_braces(word)) {
      if (std::ranges::find(known, name) != known.end()) continue;
      if (is_program_text(word))
        strange.push_back(name);
      else
        refuse(fmt::format("has the unknown {}; known: {}{}", name, fmt::join(known, ", "),
                           suggestion(name, known)));
    }
  for (const std::vector<std::string>& group : needed) {
    if (std::ranges::any_of(group, [&](const std::string& name) { return has_placeholder(command, name); }))
      continue;
    for (const std::string& name : strange)
      if (const std::string near = suggestion(name, group); !near.empty())
        refuse("has the unknown " + name + near);
    refuse(fmt::format("lacks {}", fmt::join(group, ", and in its place ")));
  }
}

bool has_placeholder(const std::vector<std::string>& command, const std::string& placeholder) {
  return std::ranges::any_of(command, [&](const std::string& w) { return w.find(placeholder) != w.npos; });
}

void check_folder_name(const TomlTable& table, const std::string& name,
                       const std::vector<std::string>& others) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  };
  if (name.empty() || name.front() == '.' || name.size() > 100 || !std::ranges::all_of(name, plain))
    throw InputError(table.where("name") + ": '" + name +
                     "' names a folder: expected letters, digits, '_', '-' and '.', not at the front");
  for (const std::string& other : others)
    if (lower_case(other) == lower_case(name))
      throw InputError(table.where("name") + ": a second case '" + name + "'" +
                       (other == name ? "" : ": beside '" + other + "' it would share its folder"));
  for (const std::string& file : result_files())
    if (lower_case(name) == file)
      refuse("{}: '{}' is the name of a file of results: expected another name", table.where("name"), name);
}

namespace {

bool makes_quads(const std::string& text) {
  try {
    return parse_pipeline(text).result == PatchForm::kQuads;
  } catch (const InputError&) {
    return false;  // a peer
  }
}

void check_reference_pipeline(const std::string& text) {
  parse_pipeline(text);
  if (!makes_quads(text))
    throw InputError("'calibrate_to' is '" + text +
                     "', which makes no quads: expected a pipeline such as DBCO");
}

void check_command(const TomlTable& table, const char* key, const std::vector<std::string>& command) {
  if (command[0].empty())
    refuse("{}: '{}' is empty: expected a program and its arguments", table.where(key), key);
}

/// A program with a slash counts from the folder of the file; others may be installed or not.
void check_program(const TomlTable& table, const char* key, const std::vector<std::string>& command) {
  const std::filesystem::path program = command[0];
  if (program.is_absolute() || command[0].find('/') == std::string::npos) return;
  const std::filesystem::path file = table.file().parent_path() / program;
  if (!std::filesystem::is_regular_file(file))
    refuse("{}: '{}': there is no program '{}': expected its path from the folder of this file",
           table.where(key), key, file.string());
}

}  // namespace

std::vector<Metric> Experiment::known_metrics() const {
  std::vector<Metric> all(metric_registry().begin(), metric_registry().end());
  const auto add = [&](const std::vector<Metric>& more) { all.insert(all.end(), more.begin(), more.end()); };
  add(criteria_metrics());
  add(anisotropic_measures());
  for (const std::string& solver : solvers) add(metrics_of_solver(solver));
  for (const MetricCommand& command : metrics) all.push_back(command.metric);
  return all;
}

std::vector<std::string> Experiment::keys_of_metrics() const {
  std::vector<std::string> keys;
  for (const Metric& metric : known_metrics()) keys.push_back(metric.key);
  return keys;
}

void finish_reading(const TomlTable& table, MetricCommand& command) {
  Metric& metric = command.metric;
  const auto plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
  if (metric.key.size() > 60 || std::isalpha(static_cast<unsigned char>(metric.key[0])) == 0 ||
      !std::ranges::all_of(metric.key, plain))
    throw InputError(table.where("name") + ": '" + metric.key +
                     "': the name of a metric is a letter, then letters, digits, '_' and '-'");
  check_command(table, "command", command.command);
  check_placeholders(table, command.command, metric_placeholders(), {{"{mesh}", "{folder}"}});
  for (const std::string& name : command.files)
    if (!std::filesystem::is_regular_file(command.folder / name))
      throw InputError(table.where("files") + ": no file '" + (command.folder / name).string() + "'");
  if (metric.title.empty()) metric.title = metric.key;
  metric.source = fmt::format("{}", fmt::join(command.command, " "));
}

void finish_reading(const TomlTable& table, Peer& peer) {
  peer.file = table.file();
  check_folder_name(table, peer.name, {});
  if (!std::islower(static_cast<unsigned char>(peer.name[0])))
    throw InputError(table.where("name") + ": '" + peer.name +
                     "': the name of a peer begins with a small letter, unlike pipelines");
  check_command(table, "command", peer.command);
  check_command(table, "version", peer.version);
  check_placeholders(table, peer.command, peer_placeholders(), {{"{input}", "{case}"}, {"{output}"}});
  check_program(table, "command", peer.command);
  check_program(table, "version", peer.version);
  for (const auto& [key, given] : {std::pair("planar", peer.planar), std::pair("surfaces", peer.surfaces)})
    if (given == HandOver::kTriangles && peer.input == kGmshScript)
      refuse("{}: '{}' is \"triangles\", which 'input = \"geo\"' cannot hold", table.where(key), key);
  if (has_placeholder(peer.command, "{size_field}") == peer.size_field.empty())
    refuse("{}: {{size_field}} in 'command' and the key 'size_field' need each other",
           table.where("command"));
}

void Experiment::check_metrics(const TomlTable& table) const {
  std::vector<std::string> taken = keys_of_metrics();
  taken.resize(taken.size() - metrics.size());
  for (const Metric& one : columns_of_records()) taken.push_back(one.key);
  for (const TomlTable& one : table.tables("metric")) {
    const std::string name = one.text("name");
    if (std::ranges::find(taken, name) != taken.end())
      throw InputError(one.where("name") + ": there is a metric '" + name + "' already");
    taken.push_back(name);
  }
}

/// Takes the peers of the file and of the files that it names.
void Experiment::settle_calibration(const TomlTable& table) {
  // By the file's own list: which of it is run must not change what peers are compared at.
  const auto first =
      std::ranges::find_if(pipelines, [](const std::string& name) { return makes_quads(name); });
  if (!calibrate_to.empty())
    located(table.where("calibrate_to"), [&] { check_reference_pipeline(calibrate_to); });
  else if (first != pipelines.end())
    calibrate_to = *first;
  else if (calibrate)
    throw InputError(table.where("calibrate") +
                     ": 'pipelines' has no pipeline that makes quads: expected 'calibrate_to = \"DBCO\"'");
  if (calibrate || table.has("calibrate_to"))
    calibrate_where = table.where(calibrate ? "calibrate" : "calibrate_to");
  add_peers(table.tables("peer"), std::exchange(peers, {}));
  for (const std::filesystem::path& name : std::exchange(peer_files, {}))
    located(table.where("peer_files"), [&] { add_peer_file(name); });
}

void Experiment::add_peers(const std::vector<TomlTable>& tables, std::vector<Peer> added) {
  for (std::size_t i = 0; i < added.size(); ++i) {
    Peer& peer = added[i];
    const TomlTable& table = tables[i];
    if (std::ranges::find(peers, peer.name, &Peer::name) != peers.end())
      throw InputError(table.where("name") + ": a second peer '" + peer.name + "'");
    if (!peer.calibrate_to.empty())
      located(table.where("calibrate_to"), [&] { check_reference_pipeline(peer.calibrate_to); });
    else
      peer.calibrate_to = calibrate_to;
    if (!peer.calibrate) peer.calibrate = calibrate;
    if (!*peer.calibrate) peer.calibrate_to.clear();
    if (*peer.calibrate && peer.calibrate_to.empty())
      throw InputError(table.where("calibrate") +
                       ": 'calibrate' needs a pipeline of Delquad: 'pipelines' has none " +
                       "that makes quads: expected 'calibrate_to = \"DBCO\"'");
    peers.push_back(std::move(peer));
  }
}

const Axis& find_axis(const std::vector<Axis>& axes, const std::string& title, const TomlTable& table,
                      const char* key) {
  std::vector<std::string> titles;
  for (const Axis& axis : axes) {
    if (axis.title == kSeedAxis) continue;
    if (axis.title == title) return axis;
    titles.push_back(axis.title);
  }
  refuse("{}: '{}' does not vary: expected what tables call a key of [matrix]{}", table.where(key), title,
         suggestion_or_all(title, titles));
}

void Experiment::check_plan(const TomlTable& table) const {
  for (const std::string& axis : pairs) find_axis(axes, axis, table, "pairs");
  for (std::size_t i = 0; i < hypotheses.size(); ++i) check_hypothesis(hypothesis_tables_[i], hypotheses[i]);
  const std::vector<TomlTable> tables = table.tables("may_fail");
  for (std::size_t i = 0; i < may_fail.size(); ++i) check_may_fail(tables[i], may_fail[i]);
}

/// Before pipelines are chosen that the file does not name.
void Experiment::check_may_fail(const TomlTable& table, const MayFail& cells) const {
  std::vector<std::string> names, variants, known = pipelines;
  for (const TomlTable& one : cases_) names.push_back(one.text("name"));
  for (const TomlTable& variant : variants_) variants.push_back(variant.text("name"));
  for (const auto& [key, text, all] : {std::tuple("case", cells.name, &names),
                                       {"variant", cells.variant, &variants},
                                       {"pipeline", cells.pipeline, &known}})
    if (!text.empty() && std::ranges::find(*all, text) == all->end())
      throw InputError(table.where(key) + ": the experiment has no " + key + " '" + text + "'" +
                       suggestion(text, *all));
  if (cells == MayFail())
    refuse("{}: does not say which cells may fail: expected 'case', 'variant' or 'pipeline'", table.where());
}

void Experiment::check_hypothesis(const TomlTable& table, const Hypothesis& h) const {
  if (h.better == h.than)
    refuse("{}: '{}' is compared with itself: expected another one", table.where("than"), h.than);
  if (!h.along.empty()) {
    const std::vector<std::string>& values = find_axis(axes, h.along, table, "along").values;
    for (const auto& [key, value] : {std::pair("better", h.better), std::pair("than", h.than)})
      if (std::ranges::find(values, value) == values.end())
        refuse("{}: '{}' is no value of '{}'{}", table.where(key), value, h.along,
               suggestion_or_all(value, values));
  }
  const std::vector<Metric> known = known_metrics();
  for (const std::string& key : h.measures) {
    const auto refuse_measure = [&](const std::string& why) {
      refuse("{}: the hypothesis has the measure '{}': {}", table.where("measures"), key, why);
    };
    if (key.starts_with("seconds"))
      refuse_measure("a time of one run is no sample: expected another measure; runs.csv has the times");
    const auto at = std::ranges::find(known, key.substr(0, key.find('.')), &Metric::key);
    if (at == known.end()) refuse_measure("there is none of that key" + suggestion(key, keys_of_metrics()));
    if (at->better == Better::kNeither) refuse_measure("neither more nor less of it is better");
  }
}

void Experiment::check_hypotheses() const {
  // The keys of a peer tell which cases it can mesh, without a look into files.
  const auto may_mesh = [&](const Pipeline& pipeline, const Case& c) {
    const Peer* peer = peer_of(pipeline);
    if (peer == nullptr) return pipeline.result == PatchForm::kQuads;
    const bool planar = planar_model(c) != nullptr, on_surface = !example_of(c).empty();
    return (peer->planar != HandOver::kNothing && !on_surface) ||
           (peer->surfaces != HandOver::kNothing && !planar);
  };
  std::vector<std::string> run;
  for (const Pipeline& pipeline : parsed) run.push_back(pipeline.text);
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    const Hypothesis& h = hypotheses[i];
    const TomlTable& table = hypothesis_tables_[i];
    std::vector<Pipeline> compared;
    for (const auto& [key, text] : {std::pair("better", h.better), std::pair("than", h.than)}) {
      const auto at = std::ranges::find(parsed, text, &Pipeline::text);
      if (!h.along.empty()) continue;
      if (at == parsed.end())
        refuse("{}: '{}' is none of the pipelines that are run (--pipelines counts){}", table.where(key),
               text, suggestion_or_all(text, run));
      compared.push_back(*at);
    }
    const std::size_t needed = h.along.empty() ? 2 : 1;
    bool shared = false;
    for (std::size_t k = 0; k < n_cases() && !shared; ++k) {
      const Case c = read_variant(k);
      const auto makes_quads_of_it = [&](const Pipeline& pipeline) { return may_mesh(pipeline, c); };
      const auto made = std::ranges::count_if(h.along.empty() ? compared : parsed, makes_quads_of_it);
      shared = static_cast<std::size_t>(made) >= needed;
    }
    if (!shared)
      refuse("{}: '{}' and '{}' have quads of no case in common: expected such a case", table.where("than"),
             h.better, h.than);
  }
}

void Experiment::check_calibration() const {
  if (calibrate_where.empty()) return;
  const std::string head =
      fmt::format("{}: '{}' has no effect: ", calibrate_where, calibrate ? "calibrate" : "calibrate_to");
  if (peers.empty()) refuse("{}there are no peers: expected [[peer]] tables, 'peer_files' or --peer", head);
  const auto is_calibrated = [](const Peer& peer) { return !peer.calibrate_to.empty(); };
  if (!calibrate && std::ranges::none_of(peers, is_calibrated))
    throw InputError(head + "expected 'calibrate = \"quads\"' beside it");
}

std::vector<std::string> Experiment::add_peer_file(const std::filesystem::path& path) {
  const TomlTable table = TomlTable::read(path);
  PeerFile file_of_peers;
  if (table.keys().empty()) throw InputError(path.string() + ": no peers: expected [[peer]] tables");
  read_described(table, file_of_peers);
  std::vector<std::string> names;
  for (const Peer& peer : file_of_peers.peers) names.push_back(peer.name);
  add_peers(table.tables("peer"), std::move(file_of_peers.peers));
  peer_files.push_back(path);
  return names;
}

}  // namespace delquad
