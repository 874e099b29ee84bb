// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/metric_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "base/located.h"
#include "base/text.h"
#include "delquad/error.h"
#include "experiments/sweep/peer.h"
#include "experiments/sweep/run_program.h"
#include "io/digest.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;

/// Limits for the output of a program: bytes that are read, and bytes that a message shows.
constexpr std::size_t kMostRead = std::size_t{1} << 20, kMostShown = 200;

std::string size_argument(const Case& c) {
  const auto size = uniform_size(c);
  if (!size) throw InputError("its command takes one size, and the size varies here");
  return fmt::format("{}", *size);
}

std::string read_start(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string text(kMostRead, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

std::string last_line(const std::string& text) {
  return std::string(trimmed(text.substr(text.rfind('\n') + 1)));
}
std::string how_it_failed(const MetricCommand& metric, const ProgramRun& run, const fs::path& errors) {
  if (metric.timeout > 0 && run.error == 0 && run.seconds >= metric.timeout && run.status != 0)
    return fmt::format("{}: ran longer than its timeout of {} s", metric.command[0], metric.timeout);
  const std::string end = how_it_ended(run);
  return end.empty() ? "" : metric.command[0] + ": " + end + complaint(errors);
}

bool is_plain(const std::string& name) {
  return !name.empty() && name.size() <= 100 && std::ranges::all_of(name, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  });
}

MetricOutcome failed(std::string reason) { return {{}, std::move(reason)}; }

MetricOutcome values_of(const std::string& key, const nlohmann::json& object) {
  MetricOutcome outcome;
  if (object.empty()) return failed("printed an empty object");
  for (const auto& [name, value] : object.items()) {
    if (!is_plain(name))
      return failed("printed the name '" + name.substr(0, kMostShown) +
                    "': expected letters, digits, '_' and '-'");
    if (!value.is_number() && !value.is_null()) return failed("printed '" + name + "', which is no number");
    const double number = value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
    if (std::isinf(number)) return failed("printed '" + name + "', which is infinite");
    outcome.values[key + "." + name] = number;
  }
  return outcome;
}

}  // namespace

const std::vector<std::string>& metric_placeholders() {
  static const std::vector<std::string> all = {"{mesh}",     "{folder}", "{case}",
                                               "{pipeline}", "{size}",   "{seed}"};
  return all;
}

MetricOutcome parse_metric_output(const std::string& key, const std::string& printed) {
  const std::string text(trimmed(printed));
  if (text.empty()) return failed("printed nothing");
  for (const std::string& part : {text, last_line(text)}) {
    if (const auto number = as_number(part)) {
      if (std::isinf(*number)) return failed("printed an infinite number");
      return {{{key, *number}}, ""};
    }
    const nlohmann::json json = nlohmann::json::parse(part, nullptr, false);
    if (json.is_object()) return values_of(key, json);
  }
  return failed("printed what is neither a number nor a JSON object of numbers: " +
                last_line(text).substr(0, kMostShown));
}

MetricOutcome run_metric(const MetricCommand& metric, const Case& c, const std::string& pipeline,
                         const fs::path& folder) {
  const fs::path at = fs::absolute(folder);
  const std::string name = "metric-" + metric.metric.key;
  const fs::path out = at / (name + ".out"), err = at / (name + ".err");
  try {
    const std::vector<std::string> words = filled_in(metric.folder, metric.command,
                                                     {{"{size}", [&] { return size_argument(c); }},
                                                      {"{mesh}", [&] { return (at / "mesh.msh").string(); }},
                                                      {"{folder}", [&] { return at.string(); }},
                                                      {"{case}", [&] { return c.name; }},
                                                      {"{pipeline}", [&] { return pipeline; }},
                                                      {"{seed}", [&] { return std::to_string(c.seed); }}});
    const ProgramRun run = run_program(words, at, out, static_cast<unsigned>(metric.timeout), err);
    if (std::string failure = how_it_failed(metric, run, err); !failure.empty())
      return failed(std::move(failure));
    MetricOutcome outcome = parse_metric_output(metric.metric.key, read_start(out));
    if (!outcome.failure.empty()) outcome.failure = metric.command[0] + ": " + outcome.failure;
    return outcome;
  } catch (const InputError& error) {
    return failed(error.what());
  } catch (const std::system_error& error) {
    return failed(error.what());
  }
}

std::map<std::string, std::string> metric_files(const MetricCommand& metric) {
  std::map<std::string, std::string> digests = command_files(metric.folder, metric.command);
  for (const std::string& name : metric.files)
    digests[name] =
        located("metric '" + metric.metric.key + "'", [&] { return file_digest(metric.folder / name); });
  return digests;
}

}  // namespace delquad
