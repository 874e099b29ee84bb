#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <limits>

#include "base/located.h"
#include "delquad/error.h"
#include "experiments/sweep/experiment.h"
#include "experiments/sweep/experiment_keys.h"
#include "experiments/sweep/schema.h"
#include "metrics/judgement/criteria.h"
#include "metrics/metrics.h"
#include "metrics/solve/solver_metrics.h"
#include "metrics/tables/table.h"

// The measures and the peers of an experiment.

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

/// Whether `calibrate` asks for as many quads as ours.
bool read_calibrate(const TomlTable& table, bool absent) {
  const std::string text = table.text("calibrate", absent ? "quads" : "none");
  if (text == "quads" || text == "none") return text == "quads";
  throw InputError(
      fmt::format("{}: 'calibrate' is '{}': expected \"quads\" or \"none\"", table.where("calibrate"), text));
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
  throw InputError(fmt::format("{}: '{}' is '{}': expected \"{}\", \"triangles\" or \"none\"",
                               table.where(key), key, text, name_of_plain));
}

/// What a peer is given of planar domains, surfaces and sizes.
void read_domains(const TomlTable& table, Peer& peer) {
  peer.planar = read_hand_over(table, "planar", HandOver::kModel, "boundary");
  peer.surfaces = read_hand_over(table, "surfaces", HandOver::kModel, "file");
  for (const auto& [key, given] : {std::pair("planar", peer.planar), std::pair("surfaces", peer.surfaces)})
    if (given == HandOver::kTriangles && peer.input == kGmshScript)
      throw InputError(fmt::format("{}: '{}' is \"triangles\", which 'input = \"geo\"' cannot hold",
                                   table.where(key), key));
  peer.size_field = table.text("size_field", "");
  const std::vector<std::string>& known = size_field_formats();
  if (table.has("size_field") && std::ranges::find(known, peer.size_field) == known.end())
    throw InputError(fmt::format("{}: 'size_field' is '{}': expected one of {}", table.where("size_field"),
                                 peer.size_field, fmt::join(known, ", ")));
  if (has_placeholder(peer.command, "{size_field}") == peer.size_field.empty())
    throw InputError(fmt::format("{}: {{size_field}} in 'command' and the key 'size_field' need each other",
                                 table.where("command")));
}

}  // namespace

std::vector<std::string> Experiment::keys_of_metrics() const {
  std::vector<std::string> keys;
  for (const Metric& m : metric_registry()) keys.push_back(m.key);
  for (const Metric& m : criteria_metrics()) keys.push_back(m.key);
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
  taken.emplace_back("seconds");
  for (const TableColumn& column : columns_of_records()) taken.push_back(column.key);
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
      throw InputError(fmt::format("{}: '{}' is '{}': expected one of {}", table.where(key), key, format,
                                   fmt::join(known, ", ")));
    extension = "." + format;
  };
  peer.command = read_command(table, "command");
  check_placeholders(table, peer.command, peer_placeholders(), {{"{input}"}, {"{output}"}});
  peer.version = read_command(table, "version");
  read_format("input", {"geo", "msh", "obj", "inp", "mesh"}, peer.input);
  read_format("output", {"msh", "obj", "off", "stl"}, peer.output);
  if (table.has("exit_codes")) peer.exit_codes = read_counts(table, "exit_codes", 0, 255);
  peer.keeps_boundary = table.flag("keeps_boundary", peer.keeps_boundary);
  peer.optional = table.flag("optional", peer.optional);
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

void Experiment::check_calibration() const {
  if (calibrate_where.empty()) return;
  const std::string head =
      fmt::format("{}: '{}' has no effect: ", calibrate_where, calibrate ? "calibrate" : "calibrate_to");
  if (peers.empty())
    throw InputError(head + "there are no peers: expected [[peer]] tables, 'peer_files' or --peer");
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
