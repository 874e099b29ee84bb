#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include "base/located.h"
#include "base/nearest_name.h"
#include "delquad/error.h"
#include "experiments/sweep/experiment.h"
#include "experiments/sweep/schema.h"
#include "metrics/judgement/criteria.h"
#include "metrics/metric_measures.h"
#include "metrics/metrics.h"
#include "metrics/solve/solver_metrics.h"
#include "metrics/tables/table.h"
#include "metrics/tables/tables.h"

// The measures and the peers of an experiment.

namespace delquad {

namespace {

std::string lower_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

/// What looks like placeholders, such as "{input}"; not "${input}", which is the shell's.
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

std::vector<int> read_counts(const TomlTable& table, const std::string& key, double least, double most) {
  std::vector<int> counts;
  for (const double n : table.numbers(key)) {
    if (n != std::floor(n) || n < least || n > most)
      refuse("{}: '{}' must hold integers from {} to {}", table.where(key), key, static_cast<int>(least),
             static_cast<int>(most));
    counts.push_back(static_cast<int>(n));
  }
  if (counts.empty()) throw InputError(table.where(key) + ": '" + key + "' is empty");
  return counts;
}

std::vector<std::string> read_command(const TomlTable& table, const char* key) {
  std::vector<std::string> command = table.texts(key);
  if (!command.empty() && !command[0].empty()) return command;
  refuse("{}: '{}' is empty: expected a program and its arguments", table.where(key), key);
}

int read_count(const TomlTable& table, const char* key, int least, int most, int absent) {
  const long long count = table.integer(key, absent);
  if (!table.has(key) || (count >= least && count <= most)) return static_cast<int>(count);
  refuse("{}: '{}' is {}: expected {} to {}", table.where(key), key, count, least, most);
}

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
      refuse("{}: '{}' names a folder, but that of a file of results", table.where("name"), name);
}

namespace {

Better read_better(const TomlTable& table) {
  const std::string text = table.text("better", "neither");
  if (text == "higher") return Better::kHigher;
  if (text == "lower") return Better::kLower;
  if (text == "neither") return Better::kNeither;
  refuse("{}: 'better' is '{}': expected \"higher\", \"lower\" or \"neither\"", table.where("better"), text);
}

/// Whether `calibrate` asks for as many quads as ours.
bool read_calibrate(const TomlTable& table, bool absent) {
  const std::string text = table.text("calibrate", absent ? "quads" : "none");
  if (text == "quads" || text == "none") return text == "quads";
  refuse("{}: 'calibrate' is '{}': expected \"quads\" or \"none\"", table.where("calibrate"), text);
}

bool makes_quads(const std::string& text) {
  try {
    return parse_word(text).result == PatchForm::kQuads;
  } catch (const InputError&) {
    return false;  // a peer
  }
}

void check_reference_word(const std::string& text) {
  parse_word(text);
  if (!makes_quads(text)) throw InputError("'calibrate_to' is '" + text + "', which makes no quads");
}

HandOver read_hand_over(const TomlTable& table, const char* key, HandOver plain, const char* name_of_plain) {
  const std::string text = table.text(key, name_of_plain);
  if (text == name_of_plain) return plain;
  if (text == "triangles") return HandOver::kTriangles;
  if (text == "none") return HandOver::kNothing;
  refuse("{}: '{}' is '{}': expected \"{}\", \"triangles\" or \"none\"", table.where(key), key, text,
         name_of_plain);
}

/// What a peer is given of planar domains, surfaces and sizes.
void read_domains(const TomlTable& table, Peer& peer) {
  peer.planar = read_hand_over(table, "planar", HandOver::kModel, "boundary");
  peer.surfaces = read_hand_over(table, "surfaces", HandOver::kModel, "file");
  for (const auto& [key, given] : {std::pair("planar", peer.planar), std::pair("surfaces", peer.surfaces)})
    if (given == HandOver::kTriangles && peer.input == kGmshScript)
      refuse("{}: '{}' is \"triangles\", which 'input = \"geo\"' cannot hold", table.where(key), key);
  peer.size_field = table.text("size_field", "");
  const std::vector<std::string>& known = size_field_formats();
  if (table.has("size_field") && std::ranges::find(known, peer.size_field) == known.end())
    refuse("{}: 'size_field' is '{}': expected one of {}", table.where("size_field"), peer.size_field,
           fmt::join(known, ", "));
  if (has_placeholder(peer.command, "{size_field}") == peer.size_field.empty())
    refuse("{}: {{size_field}} in 'command' and the key 'size_field' need each other",
           table.where("command"));
  peer.metrics = table.flag("metrics", peer.metrics);
}

}  // namespace

std::vector<Metric> Experiment::known_metrics() const {
  std::vector<Metric> all(metric_registry().begin(), metric_registry().end());
  const auto add = [&](const std::vector<Metric>& more) { all.insert(all.end(), more.begin(), more.end()); };
  add(criteria_metrics());
  add(metrics_by_metric());
  for (const std::string& solver : solvers) add(metrics_of_solver(solver));
  for (const MetricCommand& command : metrics) all.push_back(command.metric);
  return all;
}

std::vector<std::string> Experiment::keys_of_metrics() const {
  std::vector<std::string> keys;
  for (const Metric& metric : known_metrics()) keys.push_back(metric.key);
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
  taken.emplace_back("seconds");
  for (const Metric& one : columns_of_records()) taken.push_back(one.key);
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

namespace {

/// A program with a slash counts from the folder of the file; others may be installed or not.
void check_program(const TomlTable& table, const char* key, const std::vector<std::string>& command) {
  const std::filesystem::path program = command[0];
  if (program.is_absolute() || command[0].find('/') == std::string::npos) return;
  const std::filesystem::path file = table.file().parent_path() / program;
  if (!std::filesystem::is_regular_file(file))
    refuse("{}: '{}': there is no program '{}'", table.where(key), key, file.string());
}

}  // namespace

void Experiment::read_peer(const TomlTable& table) {
  Peer peer;
  peer.name = table.text("name");
  peer.file = table.file();
  peer.folder = table.file().parent_path();
  check_folder_name(table, peer.name, {});
  if (!std::islower(static_cast<unsigned char>(peer.name[0])))
    throw InputError(table.where("name") + ": '" + peer.name +
                     "': the name of a peer begins with a small letter, unlike words of stages");
  if (std::ranges::find(peers, peer.name, &Peer::name) != peers.end())
    throw InputError(table.where("name") + ": a second peer '" + peer.name + "'");
  const auto read_format = [&](const char* key, const std::vector<std::string>& known,
                               std::string& extension) {
    const std::string format = table.text(key, extension.substr(1));
    if (std::ranges::find(known, format) == known.end())
      refuse("{}: '{}' is '{}': expected one of {}", table.where(key), key, format, fmt::join(known, ", "));
    extension = "." + format;
  };
  peer.command = read_command(table, "command");
  check_placeholders(table, peer.command, peer_placeholders(), {{"{input}", "{case}"}, {"{output}"}});
  peer.version = read_command(table, "version");
  check_program(table, "command", peer.command);
  check_program(table, "version", peer.version);
  read_format("input", {"geo", "msh", "obj", "inp", "mesh"}, peer.input);
  read_format("output", {"msh", "obj", "off", "stl"}, peer.output);
  if (table.has("exit_codes")) peer.exit_codes = read_counts(table, "exit_codes", 0, 255);
  peer.keeps_boundary = table.flag("keeps_boundary", peer.keeps_boundary);
  read_domains(table, peer);
  const std::string word = table.text("calibrate_to", calibrate_to);
  if (table.has("calibrate_to")) located(table.where("calibrate_to"), [&] { check_reference_word(word); });
  if (read_calibrate(table, calibrate)) {
    if (word.empty())
      throw InputError(table.where("calibrate") +
                       ": 'calibrate' needs a word of ours: 'pipelines' has none " +
                       "that makes quads: expected 'calibrate_to = \"DBCO\"'");
    peer.calibrate_to = word;
  }
  table.finish(peer_keys());
  peers.push_back(std::move(peer));
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

void Experiment::read_plan(const TomlTable& table) {
  if (table.has("pairs")) pairs = table.texts("pairs");
  for (const std::string& axis : pairs) find_axis(axes, axis, table, "pairs");
  hypothesis_tables_ = table.tables("hypotheses");
  if (linf && !hypothesis_tables_.empty())
    throw InputError(table.where("hypotheses") + ": 'linf_delaunay' has no hypotheses");
  for (const TomlTable& hypothesis : hypothesis_tables_) read_hypothesis(hypothesis);
  for (const TomlTable& cells : table.tables("may_fail")) read_may_fail(cells);
  if (table.has("minutes")) minutes = table.positive_number("minutes");
}

/// Before pipelines are chosen that the file does not name.
void Experiment::read_may_fail(const TomlTable& table) {
  if (linf) throw InputError(table.where() + ": 'linf_delaunay' has no cells that may fail");
  std::vector<std::string> names, variants, pipelines;
  for (const TomlTable& one : cases_) names.push_back(one.text("name"));
  for (const TomlTable& variant : variants_) variants.push_back(variant.text("name"));
  for (const Word& word : words) pipelines.push_back(word.text);
  MayFail cells;
  for (const auto& [key, known, text] : {std::tuple("case", &names, &cells.name),
                                         {"variant", &variants, &cells.variant},
                                         {"pipeline", &pipelines, &cells.pipeline}}) {
    if (!table.has(key)) continue;
    *text = table.text(key);
    if (std::ranges::find(*known, *text) == known->end())
      throw InputError(table.where(key) + ": the experiment has no " + key + " '" + *text + "'" +
                       suggestion(*text, *known));
  }
  if (table.keys().empty())
    refuse("{}: which cells may fail? expected 'case', 'variant' or 'pipeline'", table.where());
  table.finish(may_fail_keys());
  may_fail.push_back(std::move(cells));
}

void Experiment::read_hypothesis(const TomlTable& table) {
  Hypothesis h{table.text("along", ""), table.expression("better"), table.expression("than"),
               table.texts("measures")};
  table.finish(hypothesis_keys());
  if (h.better == h.than) refuse("{}: '{}' is compared with itself", table.where("than"), h.than);
  if (!h.along.empty()) {
    const std::vector<std::string>& values = find_axis(axes, h.along, table, "along").values;
    for (const auto& [key, value] : {std::pair("better", h.better), std::pair("than", h.than)})
      if (std::ranges::find(values, value) == values.end())
        refuse("{}: '{}' is no value of '{}'{}", table.where(key), value, h.along,
               suggestion_or_all(value, values));
  }
  if (h.measures.empty())
    refuse("{}: 'measures' is empty: expected keys of measures", table.where("measures"));
  const std::vector<Metric> known = known_metrics();
  for (const std::string& key : h.measures) {
    const auto refuse_measure = [&](const std::string& why) {
      refuse("{}: the hypothesis has the measure '{}': {}", table.where("measures"), key, why);
    };
    if (std::ranges::count(h.measures, key) > 1) refuse_measure("it stands there twice");
    if (key.starts_with("seconds"))
      refuse_measure("a time of one run is no sample: expected another measure; runs.csv has the times");
    const auto at = std::ranges::find(known, key.substr(0, key.find('.')), &Metric::key);
    if (at == known.end()) refuse_measure("there is none of that key" + suggestion(key, keys_of_metrics()));
    if (at->better == Better::kNeither) refuse_measure("neither more nor less of it is better");
  }
  hypotheses.push_back(std::move(h));
}

void Experiment::check_hypotheses() const {
  // What a peer can be told is known of these without looking into files.
  const auto may_mesh = [&](const Word& word, const Case& c) {
    const Peer* peer = peer_of(word);
    if (peer == nullptr) return word.result == PatchForm::kQuads;
    const bool planar = planar_model(c) != nullptr, on_surface = !example_of(c).empty();
    return (peer->planar != HandOver::kNothing && !on_surface) ||
           (peer->surfaces != HandOver::kNothing && !planar);
  };
  std::vector<std::string> run;
  for (const Word& word : words) run.push_back(word.text);
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    const Hypothesis& h = hypotheses[i];
    const TomlTable& table = hypothesis_tables_[i];
    std::vector<Word> compared;
    for (const auto& [key, text] : {std::pair("better", h.better), std::pair("than", h.than)}) {
      const auto at = std::ranges::find(words, text, &Word::text);
      if (!h.along.empty()) continue;
      if (at == words.end())
        refuse("{}: '{}' is none of the pipelines that are run (--pipelines counts){}", table.where(key),
               text, suggestion_or_all(text, run));
      compared.push_back(*at);
    }
    const std::size_t needed = h.along.empty() ? 2 : 1;
    bool shared = false;
    for (std::size_t k = 0; k < n_cases() && !shared; ++k) {
      const Case c = read_variant(k);
      const auto makes_quads_of_it = [&](const Word& word) { return may_mesh(word, c); };
      const auto made = std::ranges::count_if(h.along.empty() ? compared : words, makes_quads_of_it);
      shared = static_cast<std::size_t>(made) >= needed;
    }
    if (!shared)
      refuse("{}: there is no case of which '{}' and '{}' have quads to compare", table.where("than"),
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
  std::vector<std::string> names;
  for (const TomlTable& peer : table.tables("peer")) {
    read_peer(peer);
    names.push_back(peers.back().name);
  }
  table.finish(peer_file_keys());
  if (names.empty()) throw InputError(path.string() + ": no peers: expected [[peer]] tables");
  peer_files.push_back(path);
  return names;
}

void Experiment::read_peers(const TomlTable& table, const std::vector<std::string>& pipelines) {
  calibrate = read_calibrate(table, false);
  // By the file's own list: which of it is run must not change what peers are compared at.
  const auto first =
      std::ranges::find_if(pipelines, [](const std::string& name) { return makes_quads(name); });
  calibrate_to = table.text("calibrate_to", first == pipelines.end() ? "" : *first);
  if (table.has("calibrate_to"))
    located(table.where("calibrate_to"), [&] { check_reference_word(calibrate_to); });
  else if (calibrate && calibrate_to.empty())
    throw InputError(table.where("calibrate") +
                     ": 'pipelines' has no word that makes quads: expected 'calibrate_to = \"DBCO\"'");
  if (calibrate || table.has("calibrate_to"))
    calibrate_where = table.where(calibrate ? "calibrate" : "calibrate_to");
  for (const TomlTable& peer : table.tables("peer")) read_peer(peer);
  if (!table.has("peer_files")) return;
  for (const std::string& name : table.texts("peer_files"))
    located(table.where("peer_files"), [&] { add_peer_file(file.parent_path() / name); });
}

}  // namespace delquad
