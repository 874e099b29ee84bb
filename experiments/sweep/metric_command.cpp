#include "experiments/sweep/metric_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <system_error>

#include "base/located.h"
#include "base/text.h"
#include "delquad/error.h"
#include "experiments/sweep/peer.h"
#include "experiments/sweep/run_program.h"
#include "io/digest.h"
#include "metrics/tables/table.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;

/// Of what a program printed: as much as is read, and as much as is shown in a message.
constexpr std::size_t kMostRead = std::size_t{1} << 20, kMostShown = 200;

std::vector<std::string> fill_in(const MetricCommand& metric, const Case& c, const std::string& pipeline,
                                 const fs::path& folder) {
  std::vector<std::string> words = metric.command;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (const fs::path file = file_of_word(metric.folder, words, i); !file.empty()) {
      words[i] = file.string();
      continue;
    }
    if (words[i].find("{size}") != std::string::npos) {
      const auto size = uniform_size(c);
      if (!size) throw InputError("it is told one number for the size, which varies here");
      words[i] = replace_all(words[i], "{size}", fmt::format("{}", *size));
    }
    words[i] = replace_all(words[i], "{mesh}", (folder / "mesh.msh").string());
    words[i] = replace_all(words[i], "{folder}", folder.string());
    words[i] = replace_all(words[i], "{case}", c.name);
    words[i] = replace_all(words[i], "{pipeline}", pipeline);
    words[i] = replace_all(words[i], "{seed}", std::to_string(c.seed));
  }
  return words;
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
std::string first_line(const std::string& text) {
  return std::string(trimmed(text.substr(0, text.find('\n'))));
}

/// What it says went wrong: its first line, but of a Python traceback the last one.
std::string complaint(const std::string& errors) {
  const std::string text(trimmed(errors));
  if (text.empty()) return "";
  return ": " + (text.starts_with("Traceback") ? last_line(text) : first_line(text)).substr(0, kMostShown);
}

std::string how_it_failed(const MetricCommand& metric, const ProgramRun& run, const std::string& errors) {
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
    const ProgramRun run =
        run_program(fill_in(metric, c, pipeline, at), at, out, static_cast<unsigned>(metric.timeout), err);
    const std::string printed = read_start(out);
    if (std::string failure = how_it_failed(metric, run, read_start(err)); !failure.empty())
      return failed(std::move(failure));
    MetricOutcome outcome = parse_metric_output(metric.metric.key, printed);
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
